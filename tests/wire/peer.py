#!/usr/bin/env python3
"""A site of Tandem over UDP, written from coordination/STANDARD.md alone: handshake, agreement, start, states, farewell.

It takes over the other site's configuration, and its user holds still.

    peer.py --site 1|2 --bind PORT --peer PORT --key FILE [--host ADDRESS] [--run SECONDS] [--countdown SECONDS]
            [--leave]

--countdown: what site 1 counts down, whatever the standard allows. --leave: it leaves in the middle of the countdown.
The last line says when the start was, and what came after it.
"""

import argparse
import secrets
import socket
import struct
import sys
import time

import seal
from datagram_writer import config_hash_of, write_datagram
from datagrams import BLOCK_FIELDS, CLEAR_SIZES, VERSION, Refused, read_datagram, read_header
from noise import Handshake, tag_of

BEFORE = 1000.0      # state_time_us of the start [s]
PERIOD = 1.0 / 32.0  # of its states [s]
SETTLING = 0.3       # section 6, start, step 2 [s]
MOST = 60.0          # step 5 [s]


def micro(seconds):
    return int(round(1e6 * seconds))


class Keys:
    """The result of a handshake: numbers and keys of a session (sections 4 and 5)."""

    def __init__(self, own, peer, epoch, mine, theirs, send, receive):
        self.own, self.peer, self.epoch, self.mine, self.theirs = own, peer, epoch, mine, theirs
        self.send, self.receive, self.sequence, self.taken = send, receive, 0, set()

    def seal(self, kind, fields):
        header = {"version": VERSION, "session": self.theirs, "sender": self.own, "key_epoch": self.epoch,
                  "sequence": self.sequence}
        self.sequence += 1
        opened = write_datagram(kind, {**header, **fields})
        return opened[:20] + seal.seal(self.send, self.nonce(self.own, header["sequence"]), opened[20:],
                                       self.associated(opened, self.own, self.peer))

    def open(self, datagram):
        """The opened datagram, or None."""
        _, header = read_header(datagram)
        sequence = header["sequence"]
        if (header["session"], header["key_epoch"]) != (self.mine, self.epoch) or sequence in self.taken:
            return None
        payload = seal.open_sealed(self.receive, self.nonce(self.peer, sequence), datagram[20:],
                                   self.associated(datagram, self.peer, self.own))
        if payload is None:
            return None
        self.taken.add(sequence)
        return datagram[:20] + payload

    def nonce(self, sender, sequence):
        return struct.pack("<HHQ", sender, self.epoch, sequence)

    @staticmethod
    def associated(datagram, sender, receiver):
        return b"tandem/1" + datagram[:20] + struct.pack("<HH", sender, receiver)


class Peer:
    def __init__(self, options):
        self.options = options
        self.own, self.peer = options.site, 3 - options.site
        self.psk = bytes.fromhex(open(options.key, encoding="ascii").read().split("\n")[1])
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind((options.host, options.bind))
        self.to = (options.host, options.peer)
        self.keys, self.items, self.parts, self.is_agreed = None, {}, 0, False
        self.echo, self.newest, self.states = (0, 0.0), 0, 0
        self.round_trip, self.agreed_at, self.start = None, None, None
        self.has_left, self.after_start = False, []

    # Section 4
    def clear(self, kind, fields):
        header = {"version": VERSION, "session": 0, "sender": self.own, "key_epoch": 0, "sequence": 0,
                  "receiver": self.peer}
        datagram = write_datagram(kind, {**header, **fields})
        covered = {"HELLO": 32, "COOKIE": 48, "OPEN": 104}.get(kind)
        if not covered:
            return datagram
        return datagram[:covered] + tag_of(self.psk, datagram[:covered]) + bytes(CLEAR_SIZES[kind] - covered - 16)

    def ask(self, datagram, kind):
        """Repeats a question until its answer is there."""
        while True:
            self.socket.sendto(datagram, self.to)
            self.socket.settimeout(0.25)
            try:
                while True:
                    answer = self.socket.recv(2000)
                    found, fields = read_header(answer)
                    if found == kind:
                        return answer, read_datagram(answer)[1]
            except (socket.timeout, ConnectionError):
                pass
            except Refused as refused:
                sys.exit(f"breaks the standard: {refused}")

    def call(self):
        nonce = int(1000 * time.time()) << 20 | secrets.randbits(20)
        mine, epoch = 1 + secrets.randbits(31), 1 + secrets.randbits(15)
        answer, cookie = self.ask(self.clear("HELLO", {"nonce": nonce}), "COOKIE")
        if cookie["nonce"] != nonce or cookie["tag"] != tag_of(self.psk, answer[:48]):
            sys.exit("another tag of COOKIE")
        noise = Handshake(self.psk, self.own, self.peer, VERSION, cookie["cookie"])
        message = noise.write(struct.pack("<IHBB", mine, epoch, 0, 0))
        _, accept = self.ask(self.clear("OPEN", {"nonce": nonce, "key_epoch": epoch, "cookie": cookie["cookie"],
                                                 "noise": message}), "ACCEPT")
        theirs, agreed_epoch, _, _ = struct.unpack("<IHBB", noise.read(accept["noise"]))
        assert agreed_epoch == epoch and accept["session"] == mine
        self.keys = Keys(self.own, self.peer, epoch, mine, theirs, *noise.split())

    def answer(self):
        cookie = secrets.token_bytes(16)
        while True:
            datagram, source = self.socket.recvfrom(2000)
            kind, fields = read_datagram(datagram)
            if kind == "HELLO" and fields["tag"] == tag_of(self.psk, datagram[:32]):
                self.socket.sendto(self.clear("COOKIE", {"nonce": fields["nonce"], "cookie": cookie}), source)
            if kind == "OPEN" and fields["tag"] == tag_of(self.psk, datagram[:104]) and fields["cookie"] == cookie:
                break
        noise = Handshake(self.psk, self.peer, self.own, VERSION, cookie)
        theirs, epoch, _, _ = struct.unpack("<IHBB", noise.read(fields["noise"]))
        mine = 1 + secrets.randbits(31)
        message = noise.write(struct.pack("<IHBB", mine, epoch, 0, 0))
        self.socket.sendto(self.clear("ACCEPT", {"session": theirs, "key_epoch": epoch, "nonce": fields["nonce"],
                                                 "noise": message}), source)
        receive, send = noise.split()
        self.keys = Keys(self.own, self.peer, epoch, mine, theirs, send, receive)

    # Sections 6 to 9
    def send(self, kind, fields):
        self.socket.sendto(self.keys.seal(kind, fields), self.to)

    def send_state(self, now):
        state = dict.fromkeys(BLOCK_FIELDS, 0)
        echo_time, echo_at = self.echo
        state.update(send_time_us=micro(now), state_sequence=self.states, config_hash=self.config_hash(),
                     state_time_us=0 if self.start is None else micro(BEFORE + now - self.start))
        if echo_time:
            state.update(echo_send_time_us=echo_time, echo_hold_us=micro(now - echo_at))
        state.update({"device.position": [0.0] * 3, "device.velocity": [0.0] * 3})
        self.states += 1
        self.send("STATE", state)

    def config_hash(self):
        return config_hash_of(sorted(self.items.items(), key=lambda item: item[0].encode()))

    def on_agree(self, fields):
        self.items.update({name[5:]: value for name, value in fields.items() if name.startswith("item.")})
        self.parts |= 1 << fields["part"]
        is_whole = self.config_hash() == fields["config_hash"]
        self.send("AGREE_ACK", {"config_hash": fields["config_hash"], "parts_received": self.parts,
                                "verdict": 1 if is_whole else 0, "key": "", "value": ""})
        if is_whole:
            self.send_parts()

    def send_parts(self):
        items, parts = sorted(self.items.items(), key=lambda item: item[0].encode()), [[]]
        for item in items:
            if sum(2 + len(key.encode()) + len(value.encode()) for key, value in [*parts[-1], item]) > 1100:
                parts.append([])
            parts[-1].append(item)
        for number, part in enumerate(parts):
            self.send("AGREE", {"config_hash": self.config_hash(), "part": number, "parts": len(parts),
                                **{"item." + key: value for key, value in part}})

    def on_state(self, state, now):
        if state["send_time_us"] > self.newest:
            self.newest, self.echo = state["send_time_us"], (state["send_time_us"], now)
        if state["echo_send_time_us"]:
            self.round_trip = now - 1e-6 * state["echo_send_time_us"] - 1e-6 * state["echo_hold_us"]
        site_time = 1e-6 * state["state_time_us"] - BEFORE
        if state["state_time_us"] == 0 or not self.is_agreed or self.round_trip is None:
            return
        if site_time >= 0.0:
            self.after_start.append(site_time)
        if self.start is None and (self.own > self.peer and site_time >= -MOST or site_time >= 0.0):
            self.start = now - self.round_trip / 2.0 - site_time

    def choose(self, now):
        if self.own > self.peer or self.start is not None or not self.is_agreed or self.round_trip is None:
            return
        self.agreed_at = self.agreed_at or now
        if now - self.agreed_at > SETTLING:
            self.start = now + (self.options.countdown or max(1.0, 6.0 * self.round_trip))

    def take(self, datagram, now):
        opened = self.keys.open(datagram)
        if opened is None:
            return
        kind, fields = read_datagram(opened)
        if kind == "AGREE":
            self.on_agree(fields)
        elif kind == "AGREE_ACK":
            self.is_agreed |= fields["verdict"] == 1 and fields["config_hash"] == self.config_hash()
        elif kind == "STATE":
            self.on_state(fields, now)
        elif kind == "PATH_CHALLENGE":
            self.send("PATH_RESPONSE", {"token": fields["token"]})
        elif kind == "BYE":
            self.has_left = True

    def leave(self):
        for _ in range(10):
            self.send("BYE", {"reason": 0})
            time.sleep(0.01)

    def run(self):
        self.call() if self.own < self.peer else self.answer()
        next_state = time.monotonic()
        while not self.has_left:
            now = time.monotonic()
            if now >= next_state:
                self.send_state(now)
                next_state = max(next_state + PERIOD, now)
            self.choose(now)
            if self.start is not None and (self.options.leave or now > self.start + self.options.run):
                self.send_state(now)
                time.sleep(0.2)
                self.leave()
                break
            self.socket.settimeout(max(next_state - time.monotonic(), 1e-4))
            try:
                datagram = self.socket.recv(2000)
                self.take(datagram, time.monotonic())
            except (socket.timeout, ConnectionError):
                pass
            except Refused as refused:
                sys.exit(f"breaks the standard: {refused}")
        started = "none" if self.start is None else f"{self.start:.6f}"
        print(f"start {started} after {len(self.after_start)} last {max(self.after_start, default=0.0):.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("--site", "--bind", "--peer"):
        parser.add_argument(name, type=int, required=True)
    parser.add_argument("--key", required=True)
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--run", type=float, default=1.0)
    parser.add_argument("--countdown", type=float)
    parser.add_argument("--leave", action="store_true")
    Peer(parser.parse_args()).run()


if __name__ == "__main__":
    main()
