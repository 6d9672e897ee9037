#!/usr/bin/env python3
"""README.md shows the smallest host as it is compiled: its code block is the part of
demos/hosts/minimal_host.cpp between the two lines that start with `// README`.

    readme_example.py [CHECKOUT]           exit status 1 and a difference if they are not the same
    readme_example.py [CHECKOUT] --update  writes the code into README.md
"""

import difflib
import sys
from pathlib import Path

README = "README.md"
EXAMPLE = "demos/hosts/minimal_host.cpp"
MARKER = "// README"
FENCE_START, FENCE_END = "```cpp", "```"


def part_of_example(text):
    """Lines between the two marker lines."""
    lines = text.splitlines()
    markers = [i for i, line in enumerate(lines) if line.startswith(MARKER)]
    if len(markers) != 2:
        sys.exit(f"{EXAMPLE}: {len(markers)} lines start with '{MARKER}', must be 2")
    return lines[markers[0] + 1:markers[1]]


def block_of_readme(lines):
    """Index of the first line of the only C++ block, and of the line behind its last."""
    starts = [i for i, line in enumerate(lines) if line == FENCE_START]
    if len(starts) != 1:
        sys.exit(f"{README}: {len(starts)} blocks of C++, must be 1")
    return starts[0] + 1, lines.index(FENCE_END, starts[0] + 1)


def main(arguments):
    update = "--update" in arguments
    folders = [argument for argument in arguments if not argument.startswith("--")]
    checkout = Path(folders[0]) if folders else Path(__file__).resolve().parents[2]
    code = part_of_example((checkout / EXAMPLE).read_text(encoding="utf-8"))
    readme = (checkout / README).read_text(encoding="utf-8").splitlines()
    start, end = block_of_readme(readme)
    if update:
        readme[start:end] = code
        (checkout / README).write_text("\n".join(readme) + "\n", encoding="utf-8")
        return 0
    difference = list(difflib.unified_diff(readme[start:end], code, README, EXAMPLE, lineterm=""))
    print("\n".join(difference) or f"{README} shows {EXAMPLE} as it is ({len(code)} lines)")
    return 1 if difference else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
