"""Makes the datagrams of Tandem from fields as datagrams.py reads them."""

import struct

from datagrams import (BLOCK, BLOCK_FIELDS, CLEAR_SIZES, DEVICE_FIELDS, GRIP_FIELDS, HEADER, NUMBERS, OBJECT_FIELDS, ROLL,
                       ROUTE)


def config_hash_of(items):
    """Section 8: FNV-1a, 64 bits, folded."""
    h = 0xcbf29ce484222325
    for byte in "".join(f"{key}={value}\n" for key, value in items).encode():
        h = (h ^ byte) * 0x100000001b3 % 2**64
    return h >> 32 ^ h % 2**32


def with_length(text):
    return bytes([len(text.encode())]) + text.encode()


def write_clear(kind, f):
    route = ROUTE.pack(f["receiver"], f.get("code", 0), 0, f["nonce"])
    body = f.get("cookie", b"") + f.get("noise", b"") + f.get("tag", b"")
    return (route + body).ljust(CLEAR_SIZES[kind] - HEADER.size, b"\0")


def write_state(f):
    real = "fd"[f["profile"]]

    def reals(prefix, layout):
        return b"".join(struct.pack(f"<{count}{real}", *f[prefix + name]) for name, count in layout)

    content = BLOCK.pack(*(f[name] for name in BLOCK_FIELDS)) + reals("device.", DEVICE_FIELDS)
    if f["flags"] & 16:
        content += struct.pack("<HHI", f["grip.epoch"], f["grip.object"], f["grip.age_us"])
        content += reals("grip.", GRIP_FIELDS)
    if f["flags"] & 32:
        content += ROLL.pack(f["roll.heard"], f["roll.members"], f["roll.age_ms"])
    for i in range(f["object_count"]):
        head = struct.pack("<HBBI", f[f"object.{i}.id"], f[f"object.{i}.epoch_author"], 0, f[f"object.{i}.epoch"])
        content += head + reals(f"object.{i}.", OBJECT_FIELDS)
    return content


def write_agree(f):
    items = [(name[5:], value) for name, value in f.items() if name.startswith("item.")]
    return (struct.pack("<IBBB", f["config_hash"], f["part"], f["parts"], len(items))
            + b"".join(with_length(key) + with_length(value) for key, value in items))


def write_agree_ack(f):
    return (struct.pack("<IIB", f["config_hash"], f["parts_received"], f["verdict"])
            + with_length(f["key"]) + with_length(f["value"]))


def write_path(f):
    return struct.pack("<Q", f["token"])


WRITERS = {"STATE": write_state, "AGREE": write_agree, "AGREE_ACK": write_agree_ack,
           "BYE": lambda f: bytes([f["reason"]]), "PATH_CHALLENGE": write_path, "PATH_RESPONSE": write_path}


def write_datagram(kind, f):
    header = HEADER.pack(0x6454, f["version"], NUMBERS[kind], f["session"], f["sender"], f["key_epoch"],
                         f["sequence"])
    return header + (write_clear(kind, f) if kind in CLEAR_SIZES else WRITERS[kind](f))
