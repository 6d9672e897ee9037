"""The handshake of coordination/STANDARD.md, section 4, on Noise revision 34. Slow, and not safe against timing."""

import hashlib
import hmac
import secrets
import struct

import seal

P = 2**255 - 19
PROTOCOL = b"Noise_NNpsk0_25519_ChaChaPoly_BLAKE2b"


def x25519(scalar, point):
    """RFC 7748, section 5."""
    k = int.from_bytes(scalar, "little") & ~7 & (2**255 - 1) | 2**254
    x1 = int.from_bytes(point, "little") & (2**255 - 1)
    x2, z2, x3, z3 = 1, 0, x1, 1
    for bit in reversed(range(255)):
        if k >> bit & 1:
            x2, z2, x3, z3 = x3, z3, x2, z2
        a, b, c, d = x2 + z2, x2 - z2, x3 + z3, x3 - z3
        e = a * a - b * b
        x2, z2, x3, z3 = (a * a * b * b % P, e * (a * a + 121665 * e) % P,
                          (d * a + c * b)**2 % P, x1 * (d * a - c * b)**2 % P)
        if k >> bit & 1:
            x2, z2, x3, z3 = x3, z3, x2, z2
    return (x2 * pow(z2, P - 2, P) % P).to_bytes(32, "little")


def tag_of(key, covered):
    """The tag of HELLO, COOKIE and OPEN, over the bytes before it."""
    return hashlib.blake2b(covered, key=key, digest_size=16).digest()


class Handshake:
    """One side of NNpsk0: write and read, in turns, then split."""

    def __init__(self, psk, initiator, responder, version, cookie):
        self.h = self.ck = PROTOCOL.ljust(64, b"\0")
        self.mix_hash(b"tandem/1" + struct.pack("<HHB", initiator, responder, version) + cookie)
        self.ck, to_hash, key = self.hkdf(psk, 3)
        self.mix_hash(to_hash)
        self.key = key[:32]
        self.secret, self.theirs, self.has_written = secrets.token_bytes(32), None, False

    def hkdf(self, data, count):
        key = hmac.new(self.ck, data, hashlib.blake2b).digest()
        found = [b""]
        for number in range(1, count + 1):
            found.append(hmac.new(key, found[-1] + bytes([number]), hashlib.blake2b).digest())
        return found[1:]

    def mix_hash(self, data):
        self.h = hashlib.blake2b(self.h + data).digest()

    def mix_key(self, data):
        self.ck, key = self.hkdf(data, 2)
        self.key = key[:32]

    def mix_public(self, public, is_second):
        """Tokens e, and ee in message 2."""
        self.mix_hash(public)
        self.mix_key(public)
        if is_second:
            self.mix_key(x25519(self.secret, self.theirs))

    def write(self, terms):
        public = x25519(self.secret, (9).to_bytes(32, "little"))
        self.mix_public(public, self.theirs is not None)
        sealed = seal.seal(self.key, bytes(12), terms, self.h)
        self.mix_hash(sealed)
        self.has_written = True
        return public + sealed

    def read(self, message):
        """The terms, or None if they do not open."""
        self.theirs, sealed = message[:32], message[32:]
        self.mix_public(self.theirs, self.has_written)
        terms = seal.open_sealed(self.key, bytes(12), sealed, self.h)
        self.mix_hash(sealed)
        return terms

    def split(self):
        """Keys from initiator to responder, and back."""
        return [key[:32] for key in self.hkdf(b"", 2)]
