#!/usr/bin/env python3
"""Looks through every text file of the checkout for what no file should hold: a path of somebody's
machine, a tab, a space at the end of a line, a line end of another system.

Usage: file_rule.py CHECKOUT     Ends with 1 when a line holds one.
"""

import os
import re
import sys
from pathlib import Path

SKIPPED_FOLDERS = {".git", "build", "out", "__pycache__"}
SKIPPED_TREES = (Path("tests/fuzz/corpus"),)  # bytes for parsers, good and bad

HOMES = "|".join(("root", "home", "work"))  # in pieces, so that this file passes itself
RULES = (
    ("holds a path of one machine", re.compile(rf"(?:(?<![\w.}}\])~-])|(?<=-[ILB]))/(?:{HOMES})/")),
    ("holds a tab; indent with spaces", re.compile("\t")),
    ("ends with a space or a carriage return", re.compile(r"[ \r]$")),
)


def text_files(checkout):
    """Files of the checkout, as paths relative to it; pictures and other binaries are left out."""
    for folder, names, files in os.walk(checkout):
        here = Path(folder).relative_to(checkout)
        names[:] = sorted(name for name in names
                          if name not in SKIPPED_FOLDERS and here / name not in SKIPPED_TREES)
        for name in sorted(files):
            if name not in SKIPPED_FOLDERS:  # in a linked work tree .git is a file
                yield here / name


def read_lines(path):
    """Lines of a text file; none for a binary."""
    content = path.read_bytes()
    if b"\0" in content:
        return []
    try:
        return content.decode("utf-8").split("\n")
    except UnicodeDecodeError:
        return []


def breaks_of(checkout):
    """(file, line number, what is wrong), in the order of the files."""
    checkout = Path(checkout)
    return [(file, number, what)
            for file in text_files(checkout)
            for number, line in enumerate(read_lines(checkout / file), start=1)
            for what, pattern in RULES if pattern.search(line)]


def main(arguments):
    if len(arguments) != 1 or not Path(arguments[0]).is_dir():
        print(__doc__, file=sys.stderr)
        return 2
    breaks = breaks_of(arguments[0])
    for file, number, what in breaks:
        print(f"{file}:{number}: {what}")
    print(f"{len(breaks)} lines with something that belongs in no file")
    return 1 if breaks else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
