#!/usr/bin/env python3
"""What file_rule.py must catch and leave alone."""

import tempfile
import unittest
from pathlib import Path

import file_rule

HOME = "/" + "home" + "/"  # in pieces, for the rule reads this file too
TAB = "\t"
END = "x" + " "


def breaks_of(files):
    with tempfile.TemporaryDirectory() as folder:
        for name, content in files.items():
            path = Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return [(str(file), line, what.split()[1]) for file, line, what in file_rule.breaks_of(folder)]


class FileRuleTest(unittest.TestCase):
    def test_names_file_line_and_fault(self):
        self.assertEqual(breaks_of({"docs/a.md": f"fine\nsee {HOME}me/notes\n"}), [("docs/a.md", 2, "a")])
        self.assertEqual(breaks_of({"a.cpp": f"{TAB}int a;\n"}), [("a.cpp", 1, "a")])
        self.assertEqual(breaks_of({".ci/run": f"\n\n{END}\n"}), [(".ci/run", 3, "with")])
        self.assertEqual(breaks_of({"a.sh": "x\r\n"}), [("a.sh", 1, "with")])

    def test_paths_of_machines_in_many_places(self):
        for text in (f'"{HOME}me"', f"-I{HOME}x", f"={HOME}x", f"file://{HOME}x", HOME):
            self.assertEqual(len(breaks_of({"a": text})), 1, text)

    def test_paths_inside_a_tree_are_no_machine_paths(self):
        for text in (f"docs{HOME}index.md", f"${{checkout}}{HOME}x", f"~{HOME}x", "at home/work"):
            self.assertEqual(breaks_of({"a": text}), [], text)

    def test_leaves_builds_corpora_and_pictures_alone(self):
        for name in ("build/a", "out/a", ".git/a", "tests/fuzz/corpus/table/a"):
            self.assertEqual(breaks_of({name: TAB}), [], name)
        self.assertEqual(breaks_of({"a.png": b"\x89PNG\0" + TAB.encode()}), [])
        self.assertEqual(breaks_of({"a.bin": b"\xff" + TAB.encode()}), [])

    def test_this_checkout_can_be_clean(self):
        self.assertEqual(breaks_of({"a.cpp": "int a;\n", "empty": ""}), [])


if __name__ == "__main__":
    unittest.main()
