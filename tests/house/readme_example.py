#!/usr/bin/env python3
"""A page shows an example as it is compiled: its code block is the part of the example between the two
lines that start with a mark that names the page.

    readme_example.py [CHECKOUT] [PAGE]           exit status 1 and a difference if they are not the same
    readme_example.py [CHECKOUT] [PAGE] --update  writes the code into the page

PAGE is README.md, if none is given, or docs/c.md.
"""

import difflib
import sys
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Shown:
    """What a page shows."""

    page: str
    example: str
    marker: str
    fence_start: str

    FENCE_END = "```"


PAGES = {shown.page: shown for shown in (
    Shown("README.md", "demos/hosts/minimal_host.cpp", "// README", "```cpp"),
    Shown("docs/c.md", "tests/c_door/minimal.c", "/* docs/c.md", "```c"))}


def part_of_example(text, shown):
    """Lines between the two marker lines."""
    lines = text.splitlines()
    markers = [i for i, line in enumerate(lines) if line.startswith(shown.marker)]
    if len(markers) != 2:
        sys.exit(f"{shown.example}: {len(markers)} lines start with '{shown.marker}', must be 2")
    return lines[markers[0] + 1:markers[1]]


def block_of_page(lines, shown):
    """Index of the first line of the only such block, and of the line behind its last."""
    starts = [i for i, line in enumerate(lines) if line == shown.fence_start]
    if len(starts) != 1:
        sys.exit(f"{shown.page}: {len(starts)} blocks begin with {shown.fence_start}, must be 1")
    return starts[0] + 1, lines.index(shown.FENCE_END, starts[0] + 1)


def main(arguments):
    update = "--update" in arguments
    names = [argument for argument in arguments if not argument.startswith("--")]
    shown = PAGES[names.pop() if names and names[-1] in PAGES else "README.md"]
    checkout = Path(names[0]) if names else Path(__file__).resolve().parents[2]
    code = part_of_example((checkout / shown.example).read_text(encoding="utf-8"), shown)
    page = (checkout / shown.page).read_text(encoding="utf-8").splitlines()
    start, end = block_of_page(page, shown)
    if update:
        page[start:end] = code
        (checkout / shown.page).write_text("\n".join(page) + "\n", encoding="utf-8")
        return 0
    difference = list(difflib.unified_diff(page[start:end], code, shown.page, shown.example, lineterm=""))
    print("\n".join(difference) or f"{shown.page} shows {shown.example} as it is ({len(code)} lines)")
    return 1 if difference else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
