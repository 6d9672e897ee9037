#!/usr/bin/env python3
"""The handshake, the sealing and the cookies of Tandem once more, from the specifications alone:
Noise revision 34, RFC 7748 (X25519), RFC 8439 (ChaCha20-Poly1305), RFC 2104 and 7693 (HMAC, BLAKE2b).
Nothing but Python's standard library. Slow, and not safe against whoever measures its time.

Usage: noise_reference.py VECTORS DRAWN

VECTORS: noise_vectors.json. DRAWN: the program tandem_noise_drawn. Ends with 1 at a difference.
"""

import hashlib
import hmac
import json
import subprocess
import sys

P = 2**255 - 19
PROTOCOL = b"Noise_NNpsk0_25519_ChaChaPoly_BLAKE2b"
TAG = 16


# RFC 7748, section 5
def x25519(scalar, point):
    k = bytearray(scalar)
    k[0] &= 248
    k[31] = (k[31] & 127) | 64
    k = int.from_bytes(k, "little")
    x1 = int.from_bytes(point, "little") & (2**255 - 1)
    x2, z2, x3, z3 = 1, 0, x1, 1
    for bit in range(254, -1, -1):
        swap = (k >> bit) & 1
        if swap:
            x2, z2, x3, z3 = x3, z3, x2, z2
        a, b, c, d = x2 + z2, x2 - z2, x3 + z3, x3 - z3
        aa, bb, da, cb = a * a, b * b, d * a, c * b
        e = aa - bb
        x2, z2 = aa * bb % P, e * (aa + 121665 * e) % P
        x3, z3 = (da + cb) ** 2 % P, x1 * (da - cb) ** 2 % P
        if swap:
            x2, z2, x3, z3 = x3, z3, x2, z2
    return (x2 * pow(z2, P - 2, P) % P).to_bytes(32, "little")


def public_of(scalar):
    return x25519(scalar, (9).to_bytes(32, "little"))


# RFC 8439, section 2
def rotate(value, bits):
    return ((value << bits) | (value >> (32 - bits))) & 0xFFFFFFFF


def quarter(s, a, b, c, d):
    s[a] = (s[a] + s[b]) & 0xFFFFFFFF
    s[d] = rotate(s[d] ^ s[a], 16)
    s[c] = (s[c] + s[d]) & 0xFFFFFFFF
    s[b] = rotate(s[b] ^ s[c], 12)
    s[a] = (s[a] + s[b]) & 0xFFFFFFFF
    s[d] = rotate(s[d] ^ s[a], 8)
    s[c] = (s[c] + s[d]) & 0xFFFFFFFF
    s[b] = rotate(s[b] ^ s[c], 7)


def words(data):
    return [int.from_bytes(data[i:i + 4], "little") for i in range(0, len(data), 4)]


def chacha20_block(key, counter, nonce):
    start = words(b"expand 32-byte k") + words(key) + [counter] + words(nonce)
    s = start[:]
    for _ in range(10):
        for a, b, c, d in ((0, 4, 8, 12), (1, 5, 9, 13), (2, 6, 10, 14), (3, 7, 11, 15),
                           (0, 5, 10, 15), (1, 6, 11, 12), (2, 7, 8, 13), (3, 4, 9, 14)):
            quarter(s, a, b, c, d)
    return b"".join(((x + y) & 0xFFFFFFFF).to_bytes(4, "little") for x, y in zip(s, start))


def poly1305(key, data):
    r = int.from_bytes(key[:16], "little") & 0x0FFFFFFC0FFFFFFC0FFFFFFC0FFFFFFF
    total = 0
    for i in range(0, len(data), 16):
        total = (total + int.from_bytes(data[i:i + 16] + b"\1", "little")) * r % (2**130 - 5)
    return ((total + int.from_bytes(key[16:], "little")) % 2**128).to_bytes(16, "little")


def padded(data):
    return data + bytes(-len(data) % 16)


def seal(key, nonce, associated, text):
    stream = b"".join(chacha20_block(key, 1 + i, nonce) for i in range(len(text) // 64 + 1))
    cipher = bytes(x ^ y for x, y in zip(text, stream))
    lengths = len(associated).to_bytes(8, "little") + len(cipher).to_bytes(8, "little")
    tag = poly1305(chacha20_block(key, 0, nonce)[:32], padded(associated) + padded(cipher) + lengths)
    return cipher + tag


# Noise, sections 4.3, 5 and 9
def hkdf(chaining_key, data, outputs):
    def mac(key, text):
        return hmac.new(key, text, hashlib.blake2b).digest()
    key = mac(chaining_key, data)
    found = [b""]
    for number in range(1, outputs + 1):
        found.append(mac(key, found[-1] + bytes([number])))
    return found[1:]


class Symmetric:
    def __init__(self, prologue, psk):
        self.h = self.ck = PROTOCOL.ljust(64, b"\0")
        self.mix_hash(prologue)
        self.ck, to_hash, key = hkdf(self.ck, psk, 3)
        self.mix_hash(to_hash)
        self.key, self.n = key[:32], 0

    def mix_hash(self, data):
        self.h = hashlib.blake2b(self.h + data).digest()

    def mix_key(self, data):
        self.ck, key = hkdf(self.ck, data, 2)
        self.key, self.n = key[:32], 0

    def message(self, public, exchanged, payload):
        self.mix_hash(public)
        self.mix_key(public)
        if exchanged is not None:
            self.mix_key(exchanged)
        cipher = seal(self.key, bytes(4) + self.n.to_bytes(8, "little"), self.h, payload)
        self.n += 1
        self.mix_hash(cipher)
        return public + cipher


def handshake(case):
    """Both messages, the hash, and the keys to the responder and back."""
    e1, e2 = (bytes.fromhex(case[name]) for name in ("init_ephemeral", "resp_ephemeral"))
    state = Symmetric(bytes.fromhex(case["prologue"]), bytes.fromhex(case["psk"]))
    payloads = [bytes.fromhex(message["payload"]) for message in case["messages"]]
    public1, public2 = public_of(e1), public_of(e2)
    exchanged = x25519(e1, public2)
    if exchanged != x25519(e2, public1):
        raise AssertionError("X25519 of this script is wrong")
    messages = [state.message(public1, None, payloads[0]),
                state.message(public2, exchanged, payloads[1])]
    there, back = (key[:32] for key in hkdf(state.ck, b"", 2))
    return messages, state.h, there, back


def compute_cookie(case):
    text = b"".join(value.to_bytes(size, "little") for value, size in (
        (case["slot"], 8), (case["nonce"], 8), (case["from"], 2), (case["to"], 2)))
    return compute_tag(bytes.fromhex(case["secret"]), text)


def compute_tag(key, text):
    return hashlib.blake2b(text, key=key, digest_size=16).digest()


class Comparison:
    def __init__(self):
        self.compared = self.differences = 0

    def expect(self, name, ours, theirs):
        self.compared += 1
        if ours.hex() != theirs:
            self.differences += 1
            print(f"{name}: computed {ours.hex()}, given {theirs}")


def check_itself(comparison):
    """RFC 7748, section 5.2, and RFC 8439, section 2.8.2."""
    scalar = "a546e36bf0527c9d3b16154b82465edd62144c0ac1fc5a18506a2244ba449ac4"
    point = "e6db6867583030db3594c1a424b15f7c726624ec26b3353b10a903a6d0ab1c4c"
    comparison.expect("RFC 7748", x25519(bytes.fromhex(scalar), bytes.fromhex(point)),
                      "c3da55379de9c6908e94ea4df28d084f32eccf03491c71f754b4075577a28552")
    text = (b"Ladies and Gentlemen of the class of '99: If I could offer you only one tip for the "
            b"future, sunscreen would be it.")
    sealed = seal(bytes(range(0x80, 0xA0)), bytes.fromhex("070000004041424344454647"),
                  bytes.fromhex("50515253c0c1c2c3c4c5c6c7"), text)
    comparison.expect("RFC 8439", sealed[-TAG:], "1ae10b594f09e26a7e902ecbd0600691")


def check_vectors(comparison, vectors):
    messages, digest, there, back = handshake(vectors)
    counts = [0, 0]
    for number, message in enumerate(vectors["messages"]):
        if number >= 2:  # the transport: both directions in turns, each with a sequence of its own
            side = number % 2
            nonce = bytes(4) + counts[side].to_bytes(8, "little")
            counts[side] += 1
            messages.append(seal((there, back)[side], nonce, b"", bytes.fromhex(message["payload"])))
        comparison.expect(f"published message {number}", messages[number], message["ciphertext"])
    comparison.expect("published hash", digest, vectors["handshake_hash"])


def check_drawn(comparison, number, case):
    name = f"seed {case['seed']}, handshake {number}"
    messages, digest, there, back = handshake(case)
    for ours, theirs in zip(messages, case["messages"]):
        comparison.expect(f"{name}, message", ours, theirs["ciphertext"])
    comparison.expect(f"{name}, hash", digest, case["handshake_hash"])
    comparison.expect(f"{name}, key to the responder", there, case["to_responder"])
    comparison.expect(f"{name}, key to the initiator", back, case["to_initiator"])

    sent = case["datagram"]
    nonce = sent["sender"].to_bytes(2, "little") + sent["epoch"].to_bytes(2, "little")
    nonce += sent["sequence"].to_bytes(8, "little")
    comparison.expect(f"{name}, datagram",
                      seal(bytes.fromhex(sent["key"]), nonce, bytes.fromhex(sent["header"]),
                           bytes.fromhex(sent["text"])), sent["sealed"])
    comparison.expect(f"{name}, cookie", compute_cookie(case["cookie"]), case["cookie"]["cookie"])
    tag = case["tag"]
    comparison.expect(f"{name}, tag",
                      compute_tag(bytes.fromhex(tag["key"]), bytes.fromhex(tag["covered"])), tag["tag"])


def main(arguments):
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    comparison = Comparison()
    check_itself(comparison)
    with open(arguments[0], encoding="utf-8") as file:
        check_vectors(comparison, json.load(file))
    drawn = subprocess.run([arguments[1]], check=True, capture_output=True, text=True).stdout
    cases = [json.loads(line) for line in drawn.splitlines()]
    for number, case in enumerate(cases):
        check_drawn(comparison, number, case)
    print(f"{comparison.compared} values of {len(cases)} drawn handshakes and the published one, "
          f"{comparison.differences} differences")
    return 1 if comparison.differences or not cases else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
