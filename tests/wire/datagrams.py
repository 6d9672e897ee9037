"""Reads the datagrams of Tandem, by coordination/STANDARD.md alone; section numbers are its."""

import math
import re
import struct

VERSION = 3
MAX_TIME = 2**50
TYPES = {1: "HELLO", 2: "COOKIE", 3: "OPEN", 4: "ACCEPT", 5: "REFUSE",
         16: "STATE", 17: "AGREE", 18: "AGREE_ACK", 19: "BYE", 20: "PATH_CHALLENGE", 21: "PATH_RESPONSE"}
NUMBERS = {name: number for number, name in TYPES.items()}
CLEAR_SIZES = {"HELLO": 256, "COOKIE": 64, "OPEN": 120, "ACCEPT": 88, "REFUSE": 32}

HEADER = struct.Struct("<HBBIHHQ")
ROUTE = struct.Struct("<HBBQ")
BLOCK = struct.Struct("<qqQqIIddHBBI")
ROLL = struct.Struct("<QQI")
BLOCK_FIELDS = ("send_time_us", "state_time_us", "state_sequence", "echo_send_time_us", "echo_hold_us",
                "ack_bits", "granted", "holdings", "flags", "profile", "object_count", "config_hash")
MOTION = {"position": 1e3, "velocity": 1e2, "angular_velocity": 1e3}  # bounds of each component
DEVICE_FIELDS = (("position", 3), ("velocity", 3))
GRIP_FIELDS = (("position", 3), ("orientation", 4))
OBJECT_FIELDS = (("position", 3), ("orientation", 4), ("velocity", 3), ("angular_velocity", 3))

KEY = re.compile(rb"[A-Za-z0-9._-]{1,64}")
CONTROL = re.compile("[\x00-\x1f\x7f-\x9f]")


class Refused(Exception):
    """The name of a refusal (section 10)."""


def require(holds, name):
    if not holds:
        raise Refused(name)


def read_header(datagram):
    """Section 5, steps 1 to 3."""
    require(len(datagram) >= HEADER.size, "too_short")
    require(len(datagram) <= 1200, "too_long")
    magic, version, number, session, sender, key_epoch, sequence = HEADER.unpack_from(datagram)
    require(magic == 0x6454, "magic")
    require(version == VERSION or number == NUMBERS["REFUSE"], "version")
    require(number in TYPES, "type")
    kind = TYPES[number]
    sealed = kind not in CLEAR_SIZES
    require((session != 0) == (sealed or kind == "ACCEPT"), "session")
    require(1 <= sender <= 64, "sender")
    require((key_epoch != 0) == (sealed or kind in ("OPEN", "ACCEPT")), "key_epoch")
    require(sealed or sequence == 0, "sequence")
    return kind, {"version": version, "session": session, "sender": sender, "key_epoch": key_epoch,
                  "sequence": sequence}


def read_clear(kind, sender, datagram):
    """Section 4: what follows the header of a handshake's datagram."""
    require(len(datagram) == CLEAR_SIZES[kind], "wrong_size")
    receiver, code, zero, nonce = ROUTE.unpack_from(datagram, HEADER.size)
    body = datagram[HEADER.size + ROUTE.size:]
    require(1 <= receiver <= 64 and receiver != sender, "receiver")
    if kind == "REFUSE":
        require(1 <= code <= 5, "code")
    else:
        require(kind == "HELLO" or (sender < receiver) == (kind == "OPEN"), "role")
        require(code == 0, "zero")
    require(zero == 0, "zero")
    fields = {"receiver": receiver, "nonce": nonce}
    if kind == "HELLO":
        require(not any(body[16:]), "zero")
        fields["tag"] = body[:16]
    elif kind == "COOKIE":
        fields.update(cookie=body[:16], tag=body[16:])
    elif kind == "OPEN":
        fields.update(cookie=body[:16], noise=body[16:72], tag=body[72:])
    elif kind == "ACCEPT":
        fields["noise"] = body
    else:
        fields["code"] = code
    return fields


def read_reals(payload, offset, real, layout):
    """Named groups of reals, and where they end; section 6, step 5: all finite before any is in bounds."""
    fields = {}
    for name, count in layout:
        group = struct.Struct(f"<{count}{real}")
        fields[name] = list(group.unpack_from(payload, offset))
        offset += group.size
    require(all(math.isfinite(x) for group in fields.values() for x in group), "not_finite")
    for name, bound in MOTION.items():
        require(all(abs(x) <= bound for x in fields.get(name, [])), name)
    return fields, offset


def require_unit(orientation):
    require(abs(sum(x * x for x in orientation) - 1.0) < 1e-3, "orientation")


def read_state(payload):
    """Section 6, in the order of its gate."""
    require(len(payload) >= BLOCK.size, "too_short")
    block = dict(zip(BLOCK_FIELDS, BLOCK.unpack_from(payload)))
    require(block["profile"] <= 1, "profile")
    require(block["object_count"] <= 8, "object_count")
    real, width = ("f", 4) if block["profile"] == 0 else ("d", 8)
    has_grip, has_roll = block["flags"] & 16 != 0, block["flags"] & 32 != 0
    size = BLOCK.size + 6 * width + block["object_count"] * (8 + 13 * width)
    size += has_grip * (8 + 7 * width) + has_roll * ROLL.size
    require(len(payload) == size, "wrong_size")
    require(block["flags"] & ~63 == 0, "flags")
    require(all(0 <= block[name] <= MAX_TIME for name in BLOCK_FIELDS if "_time_us" in name), "time")
    require(all(abs(block[name]) <= 1e9 for name in ("granted", "holdings")), "energy")  # false for a NaN, too
    device, offset = read_reals(payload, BLOCK.size, real, DEVICE_FIELDS)
    block.update({f"device.{name}": value for name, value in device.items()})
    if has_grip:
        epoch, number, age = struct.unpack_from("<HHI", payload, offset)
        require(number <= 255 or number == 65535, "object_id")
        grip, offset = read_reals(payload, offset + 8, real, GRIP_FIELDS)
        require_unit(grip["orientation"])
        block.update({"grip.epoch": epoch, "grip.object": number, "grip.age_us": age})
        block.update({f"grip.{name}": value for name, value in grip.items()})
    if has_roll:
        block.update(zip(("roll.heard", "roll.members", "roll.age_ms"), ROLL.unpack_from(payload, offset)))
        offset += ROLL.size
    ids = set()
    for i in range(block["object_count"]):
        number, author, zero, epoch = struct.unpack_from("<HBBI", payload, offset)
        require(number <= 255, "object_id")
        require(number not in ids, "object_twice")
        require(zero == 0, "zero")
        require(author <= 64 and (author == 0) == (epoch == 0), "object_epoch")
        ids.add(number)
        state, offset = read_reals(payload, offset + 8, real, OBJECT_FIELDS)
        require_unit(state["orientation"])
        block.update({f"object.{i}.id": number, f"object.{i}.epoch_author": author, f"object.{i}.epoch": epoch})
        block.update({f"object.{i}.{name}": value for name, value in state.items()})
    return block


class Texts:
    """Lengths and texts, one after the other."""

    def __init__(self, payload, offset):
        self.payload, self.offset = payload, offset

    def next(self):
        require(self.offset < len(self.payload), "wrong_size")
        start = self.offset + 1
        self.offset = start + self.payload[self.offset]
        require(self.offset <= len(self.payload), "wrong_size")
        return self.payload[start:self.offset]

    def end(self):
        require(self.offset == len(self.payload), "wrong_size")


def value_text(value):
    """Text of an item's value; section 2 says which bytes are text."""
    try:
        text = value.decode("utf-8")
    except UnicodeDecodeError:
        raise Refused("value") from None
    require(text and not CONTROL.search(text), "value")
    return text


def read_agree(payload):
    require(len(payload) >= 7, "too_short")
    require(len(payload) <= 1164, "too_long")
    config_hash, part, parts, item_count = struct.unpack_from("<IBBB", payload)
    require(1 <= parts <= 32, "parts")
    require(part < parts, "part")
    texts, last, fields = Texts(payload, 7), b"", {}
    for _ in range(item_count):
        key = texts.next()
        require(KEY.fullmatch(key), "key")
        value = value_text(texts.next())
        require(key > last, "order")
        fields["item." + key.decode()] = value
        last = key
    texts.end()
    return {"config_hash": config_hash, "part": part, "parts": parts, **fields}


def read_agree_ack(payload):
    require(len(payload) >= 11, "too_short")
    config_hash, parts_received, verdict = struct.unpack_from("<IIB", payload)
    require(verdict <= 2, "verdict")
    texts = Texts(payload, 9)
    key = texts.next()
    require(KEY.fullmatch(key) if verdict == 2 else not key, "key")
    value = texts.next()
    require(verdict == 2 or not value, "value")
    text = value_text(value) if value else ""
    texts.end()
    return {"config_hash": config_hash, "parts_received": parts_received, "verdict": verdict,
            "key": key.decode(), "value": text}


def read_bye(payload):
    require(len(payload) == 1, "wrong_size")
    require(payload[0] <= 3, "reason")
    return {"reason": payload[0]}


def read_path(payload):
    require(len(payload) == 8, "wrong_size")
    return {"token": int.from_bytes(payload, "little")}


READERS = {"STATE": read_state, "AGREE": read_agree, "AGREE_ACK": read_agree_ack, "BYE": read_bye,
           "PATH_CHALLENGE": read_path, "PATH_RESPONSE": read_path}


def read_datagram(datagram):
    """Kind and fields of a clear or opened datagram; raises Refused."""
    kind, fields = read_header(datagram)
    if kind in CLEAR_SIZES:
        return kind, {**fields, **read_clear(kind, fields["sender"], datagram)}
    return kind, {**fields, **READERS[kind](datagram[HEADER.size:])}


def records_of(content):
    """Section 11; raises Refused where the file ends within a record."""
    offset = 0
    while offset < len(content):
        require(offset + 4 <= len(content), "wrong_size")
        (length,) = struct.unpack_from("<I", content, offset)
        require(offset + 4 + length <= len(content), "wrong_size")
        yield content[offset + 4:offset + 4 + length]
        offset += 4 + length
