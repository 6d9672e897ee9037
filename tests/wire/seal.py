"""ChaCha20-Poly1305 of RFC 8439, to check one golden datagram. Slow, and not safe against timing."""

import struct


def rotate(value, count):
    return (value << count | value >> (32 - count)) & 0xffffffff


def quarter_round(s, a, b, c, d):
    for left, right, target, count in ((a, b, d, 16), (c, d, b, 12), (a, b, d, 8), (c, d, b, 7)):
        s[left] = (s[left] + s[right]) & 0xffffffff
        s[target] = rotate(s[target] ^ s[left], count)


def chacha20_block(key, counter, nonce):
    start = [*struct.unpack("<4I", b"expand 32-byte k"), *struct.unpack("<8I", key), counter,
             *struct.unpack("<3I", nonce)]
    state = list(start)
    for _ in range(10):
        for column in range(4):
            quarter_round(state, column, 4 + column, 8 + column, 12 + column)
        for row in range(4):
            quarter_round(state, row, 4 + (row + 1) % 4, 8 + (row + 2) % 4, 12 + (row + 3) % 4)
    return struct.pack("<16I", *((a + b) & 0xffffffff for a, b in zip(state, start)))


def chacha20(key, nonce, text):
    blocks = (chacha20_block(key, 1 + i, nonce) for i in range((len(text) + 63) // 64))
    return bytes(a ^ b for a, b in zip(text, b"".join(blocks)))


def poly1305(key, text):
    r = int.from_bytes(key[:16], "little") & 0x0ffffffc0ffffffc0ffffffc0fffffff
    total = 0
    for i in range(0, len(text), 16):
        total = (total + int.from_bytes(text[i:i + 16] + b"\1", "little")) * r % (2**130 - 5)
    return ((total + int.from_bytes(key[16:], "little")) % 2**128).to_bytes(16, "little")


def padded(text):
    return text + bytes(-len(text) % 16)


def tag_of(key, nonce, sealed, associated_data):
    lengths = struct.pack("<2Q", len(associated_data), len(sealed))
    return poly1305(chacha20_block(key, 0, nonce)[:32], padded(associated_data) + padded(sealed) + lengths)


def seal(key, nonce, payload, associated_data):
    """Sealed payload and tag."""
    sealed = chacha20(key, nonce, payload)
    return sealed + tag_of(key, nonce, sealed, associated_data)


def open_sealed(key, nonce, sealed_and_tag, associated_data):
    """The payload, or None if it is not authentic."""
    sealed, tag = sealed_and_tag[:-16], sealed_and_tag[-16:]
    return chacha20(key, nonce, sealed) if tag == tag_of(key, nonce, sealed, associated_data) else None
