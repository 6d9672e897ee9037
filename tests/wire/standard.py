#!/usr/bin/env python3
"""The datagrams of Tandem, written from coordination/STANDARD.md alone and sharing no code with the library.

    standard.py check FOLDER    golden files against index.txt and refused.txt; ends with 1 if one differs
    standard.py seeds FOLDER    seeds of a fuzzer; ends with 1 if one is refused or a message is missing
    standard.py read FILE       a recorded run (section 11), a line per datagram; ends with 1 at a break
    standard.py write FOLDER    writes the golden files anew from index.txt
"""

import sys
from pathlib import Path

from datagrams import NUMBERS, Refused, read_datagram, records_of
from golden_files import differences, make_golden, read_index


def check(folder):
    found = list(differences(folder))
    print("\n".join(found) or f"{folder}: all golden files as the standard has them")
    return 1 if found else 0


def seeds(folder):
    missing, broken = set(NUMBERS), 0
    for file in sorted(folder.iterdir()):
        try:
            missing.discard(read_datagram(file.read_bytes())[0])
        except Refused as refused:
            print(f"{file}: refused: {refused}")
            broken = 1
    if missing:
        print(f"{folder}: no seed for {', '.join(sorted(missing))}")
    return 1 if missing or broken else 0


def write(folder):
    for file, kind, fields in read_index(folder):
        (folder / file).write_bytes(make_golden(folder, kind, fields))
    return 0


def read(file):
    done = 0
    try:
        for datagram in records_of(file.read_bytes()):
            kind, fields = read_datagram(datagram)
            done += 1
            print(done, kind, *(f"{name}={show(value)}" for name, value in fields.items()))
    except Refused as refused:
        print(f"{file}: record {done + 1} breaks the standard: {refused}")
        return 1
    return 0


def show(value):
    if isinstance(value, list):
        return ",".join(map(repr, value))
    return value.hex() if isinstance(value, bytes) else value


def main(arguments):
    commands = {"check": check, "read": read, "seeds": seeds, "write": write}
    if len(arguments) != 2 or arguments[0] not in commands:
        print(__doc__, file=sys.stderr)
        return 2
    return commands[arguments[0]](Path(arguments[1]))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
