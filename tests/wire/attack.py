#!/usr/bin/env python3
"""Two `tandem peer` on loopback, and a man in the middle without the key. Written from coordination/STANDARD.md alone.

    attack.py TANDEM SCENARIO MODE [--seconds SECONDS] [--strict]

All that the sites send goes through this program, which hands it on at once. Before that, MODE sends:

    nothing     to see what the machine does by itself
    cookies     one forged COOKIE for each HELLO
    flood       a thousand of them for each HELLO, and two with every other datagram
    copies      a copy of each datagram, from another port
    forgeries   eight replayed, changed, cut, renumbered or random datagrams with each one
    hellos      four recorded HELLOs and OPENs of the same peer with each datagram

Prints a line. Ends with 1 if more than a second's states were lost at a site, if the hands together got more than their
tanks, or a device more than its limit. With --strict it also counts the time in which a site sent no state.
"""

import argparse
import json
import os
import random
import select
import socket
import struct
import subprocess
import sys
import tempfile
import time

from datagram_writer import write_datagram
from datagrams import NUMBERS, Refused, read_datagram

RATE = 128.0      # states a second
SILENCE = 0.1     # a longer pause counts [s]
MOST_FORCE = 8.0  # [N]
TANKS = 0.04      # of both sites [J]
SEED = 20090405


class Direction:
    """What one site sends: the socket that it sends to, and the one from which the other site is reached."""

    def __init__(self, inlet):
        self.inlet, self.outlet, self.home, self.to = inlet, None, None, None
        self.heard, self.openings = [], []
        self.states, self.first, self.last, self.silent = 0, None, None, 0.0

    def note(self, datagram, now):
        if datagram[3] == NUMBERS["STATE"]:
            if self.last and now - self.last > SILENCE:
                self.silent += now - self.last
            self.states, self.first, self.last = self.states + 1, self.first or now, now
        if datagram[3] in (NUMBERS["HELLO"], NUMBERS["OPEN"]):
            self.openings.append(datagram)
        if len(self.heard) < 4096:
            self.heard.append(datagram)
        else:
            self.heard[self.states % 4096] = datagram


class Between:
    def __init__(self, mode):
        self.attack = getattr(self, mode)
        self.random = random.Random(SEED)
        self.stranger = self.bind()
        self.ways = [Direction(self.bind()), Direction(self.bind())]
        for way, other in zip(self.ways, reversed(self.ways)):
            way.outlet = other.inlet
        self.made = self.caught = 0

    @staticmethod
    def bind():
        one = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        one.bind(("127.0.0.1", 0))
        return one

    def address_for(self, site):
        return "127.0.0.1:%d" % self.ways[site - 1].inlet.getsockname()[1]

    def run_until(self, is_over):
        while not is_over():
            ready, _, _ = select.select([self.stranger] + [way.inlet for way in self.ways], [], [], 0.1)
            for one in ready:
                datagram, source = one.recvfrom(2000)
                if one is self.stranger:
                    self.caught += 1
                    continue
                way, back = self.ways if one is self.ways[0].inlet else reversed(self.ways)
                way.home = back.to = source
                if way.to:
                    way.note(datagram, time.monotonic())
                    self.attack(way, back, datagram)
                    way.outlet.sendto(datagram, way.to)

    def throw(self, outlet, datagram, to):
        outlet.sendto(datagram, to)
        self.made += 1

    # The attacks
    def nothing(self, *_):
        pass

    def cookies(self, way, _, datagram, count=1):
        if datagram[3] != NUMBERS["HELLO"]:
            return
        hello = read_datagram(datagram)[1]
        for _ in range(count):
            forged = {**hello, "sender": hello["receiver"], "receiver": hello["sender"],
                      "cookie": self.random.randbytes(16), "tag": self.random.randbytes(16)}
            self.throw(way.inlet, write_datagram("COOKIE", forged), way.home)

    def flood(self, way, back, datagram):
        self.cookies(way, back, datagram, 1000)
        if datagram[3] != NUMBERS["HELLO"] and way.openings:
            self.cookies(way, back, way.openings[-1], 2)

    def copies(self, way, _, datagram):
        self.throw(self.stranger, datagram, way.to)

    def forgeries(self, way, _, datagram):
        for _ in range(8):
            forged = bytearray(self.random.choice(way.heard))
            kind = self.random.randrange(5)
            if kind == 1:
                forged[self.random.randrange(len(forged))] ^= 1 << self.random.randrange(8)
            elif kind == 2:
                del forged[self.random.randrange(len(forged)):]
            elif kind == 3:
                forged[12:20] = struct.pack("<Q", self.random.randrange(2**63))
            elif kind == 4:
                forged[20:] = self.random.randbytes(self.random.randrange(1181))
            self.throw(self.random.choice([way.outlet, self.stranger]), forged, way.to)

    def hellos(self, way, _, __):
        for _ in range(4 if way.openings else 0):
            self.throw(way.outlet, self.random.choice(way.openings), way.to)


def start(tandem, scenario, folder, site, address, seconds):
    key = os.path.join(folder, "k.psk")
    # Both hands hold the cube between them, and move it about.
    settings = {"experiment.duration": seconds, "device.max_force": MOST_FORCE}
    for one, press in ((1, 0.015), (2, -0.015)):
        drawn = random.Random(SEED)
        points = [[0.0, 0.0, 0.0, 0.0], *([k, press + drawn.uniform(-0.03, 0.03), 0.0, 0.0]
                                          for k in range(1, int(seconds) + 2))]
        settings.update({f"site{one}.hand": '"minimum_jerk"', f"site{one}.hand_waypoints": json.dumps(points)})
    changes = [word for name, value in settings.items() for word in ("--set", f"{name}={value}")]
    return subprocess.Popen([tandem, "peer", "--scenario", scenario, *changes, "--site", str(site), "--key", key,
                             "--bind", "127.0.0.1:0", "--peer", address, "--out", folder, "--wait", "60", "--quiet"])


def judge(mode, folder, between, is_strict):
    sites = [json.load(open(os.path.join(folder, f"site{site}.json"), encoding="utf-8")) for site in (1, 2)]
    faults = []
    missing, peaks = [], []
    for number, (site, way) in enumerate(zip(sites, reversed(between.ways)), 1):
        states = site["network"]["states"]  # a busy machine overtakes some, which came all the same
        lost = max(0, way.states - states["given"] - states["stale"] - states["too_late"]) / RATE
        missing.append(f"{lost:.2f} + {way.silent:.2f}")
        if lost + (way.silent if is_strict else 0.0) > 1.0:
            faults.append(f"site {number} was not live")
        peaks.append(site[f"site{number}"]["force"]["max"])
        if peaks[-1] > MOST_FORCE * (1.0 + 1e-9):
            faults.append(f"force at site {number}")
    gained = -sum(site[f"site{number}"]["guards"]["energy_in"] for number, site in enumerate(sites, 1))
    if gained > TANKS:
        faults.append("energy")
    lasted = min(way.last - way.first for way in between.ways)
    print(f"{mode}: {lasted:.1f} s of states, {between.made} datagrams thrown in, {between.caught} caught; "
          f"without states [s, lost + not sent] {missing[0]} and {missing[1]}; energy to both hands {gained:.3f} J; "
          f"largest forces {peaks[0]:.2f} and {peaks[1]:.2f} N; handshakes {len(between.ways[0].openings)} messages"
          + "".join(f"; FAILED: {fault}" for fault in faults))
    return 1 if faults else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tandem")
    parser.add_argument("scenario")
    parser.add_argument("mode", choices=("nothing", "cookies", "flood", "copies", "forgeries", "hellos"))
    parser.add_argument("--seconds", type=float, default=2.0)
    parser.add_argument("--strict", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([options.tandem, "key", "new", os.path.join(folder, "k.psk")], check=True, capture_output=True)
        between = Between(options.mode)
        sites = [start(options.tandem, options.scenario, folder, site, between.address_for(site), options.seconds)
                 for site in (1, 2)]
        try:
            between.run_until(lambda: all(site.poll() is not None for site in sites))
        finally:
            for site in sites:
                site.kill()
        if any(site.returncode != 0 for site in sites):
            sys.exit(f"{options.mode}: FAILED: the sites ended with {[site.returncode for site in sites]}")
        sys.exit(judge(options.mode, folder, between, options.strict))


if __name__ == "__main__":
    main()
