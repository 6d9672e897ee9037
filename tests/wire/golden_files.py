"""The golden files: index.txt has their values, refused.txt what is done to them so that they are refused."""

import configparser
import hashlib
import struct
import sys

import seal
from datagram_writer import config_hash_of, write_datagram
from datagrams import HEADER, NUMBERS, VERSION, Refused, read_datagram


TEXT_FIELDS = ("key", "value")
BYTE_FIELDS = ("cookie", "noise", "tag", "key_bytes")
TAGGED = {"HELLO": 32, "COOKIE": 48, "OPEN": 104}  # bytes before the tag


def parse(name, text):
    """A value of index.txt."""
    last = name.rsplit(".", 1)[-1]
    if name.startswith("item.") or name in TEXT_FIELDS:
        return text
    if name in BYTE_FIELDS:
        return bytes.fromhex(text)
    if last in ("position", "orientation", "velocity", "angular_velocity"):
        return [float(word) for word in text.split()]
    return float(text) if last in ("granted", "holdings") else int(text, 0)


def read_index(folder):
    """File -> (kind, fields), in the order of the index."""
    index = configparser.RawConfigParser(delimiters="=", interpolation=None)
    index.optionxform = str
    index.read_string((folder / "index.txt").read_text(encoding="utf-8"))
    for file in index.sections():
        fields = dict(index[file])
        yield file, fields.pop("kind"), {name: parse(name, text) for name, text in fields.items()}


def tag_of(key, covered):
    """Section 4: the tag of HELLO, COOKIE and OPEN."""
    return hashlib.blake2b(covered, key=key, digest_size=16).digest()


def make_file(folder, kind, f):
    """Bytes of a golden file that is no datagram by itself, from the other files where it needs them."""
    if kind == "PROLOGUE":
        return b"tandem/1" + struct.pack("<HHB", f["initiator"], f["responder"], VERSION) + f["cookie"]
    if kind == "TERMS":
        return struct.pack("<IHBB", f["session"], f["key_epoch"], f["minor"], 0)
    if kind == "RECORDING":
        datagrams = [(folder / file).read_bytes() for file, other, _ in read_index(folder) if other in NUMBERS]
        return b"".join(struct.pack("<I", len(datagram)) + datagram for datagram in datagrams)
    opened = (folder / "state_float32.bin").read_bytes()
    _, _, _, _, sender, key_epoch, sequence = HEADER.unpack_from(opened)
    associated_data = b"tandem/1" + opened[:20] + struct.pack("<HH", sender, f["receiver"])
    nonce = struct.pack("<HHQ", sender, key_epoch, sequence)
    if kind == "ASSOCIATED_DATA":
        return associated_data
    if kind == "NONCE":
        return nonce
    sealed = seal.seal(f["key_bytes"], nonce, opened[20:], associated_data)
    if seal.open_sealed(f["key_bytes"], nonce, sealed, associated_data) != opened[20:]:
        sys.exit("seal.py does not open what it seals")
    return opened[:20] + sealed


def make_golden(folder, kind, fields):
    return write_datagram(kind, fields) if kind in NUMBERS else make_file(folder, kind, fields)


def spoilt(datagram, size, patches):
    """A golden datagram cut or lengthened with zeros to a size, with bytes replaced."""
    spoilt_one = bytearray(datagram[:size].ljust(size, b"\0"))
    for offset, new in patches:
        spoilt_one[offset:offset + len(new)] = new
    return bytes(spoilt_one)


def read_refused(folder):
    """Lines of refused.txt: refusal, file, size or -, then OFFSET:HEX as often as needed."""
    for line in (folder / "refused.txt").read_text(encoding="utf-8").splitlines():
        words = line.split()
        if not words or words[0] == "#":
            continue
        datagram = (folder / words[1]).read_bytes()
        size = len(datagram) if words[2] == "-" else int(words[2])
        patches = [(int(offset), bytes.fromhex(new)) for offset, new in (w.split(":") for w in words[3:])]
        yield line, words[0], spoilt(datagram, size, patches)


def refusal_of(datagram):
    try:
        read_datagram(datagram)
    except Refused as refused:
        return str(refused)
    return "none"


def differences(folder):
    """What is wrong with the golden files, a line each."""
    for file, kind, fields in read_index(folder):
        content = (folder / file).read_bytes()
        if content != make_golden(folder, kind, fields):
            yield f"{file}: other bytes than its values in index.txt make"
        if kind in NUMBERS:
            try:
                read = read_datagram(content)
            except Refused as refused:
                yield f"{file}: refused: {refused}"
                continue
            if repr(read) != repr((kind, fields)):  # tells -0.0 from 0.0
                yield f"{file}: reads as {read}, the index says {(kind, fields)}"
        covered = TAGGED.get(kind, 0)
        if covered and tag_of(bytes(range(32)), content[:covered]) != fields["tag"]:
            yield f"{file}: the tag of its bytes is {tag_of(bytes(range(32)), content[:covered]).hex()}"
        if kind == "AGREE" and fields["parts"] == 1:
            items = [(name[5:], value) for name, value in fields.items() if name.startswith("item.")]
            if config_hash_of(items) != fields["config_hash"]:
                yield f"{file}: the hash of its items is {config_hash_of(items):#x}"
    for line, refusal, datagram in read_refused(folder):
        if refusal_of(datagram) != refusal:
            yield f"refused.txt: '{line}': read as {refusal_of(datagram)}"
