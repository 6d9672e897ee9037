"""CSV tables of numbers, and text files, with messages that name file, line and column."""

from math import isfinite

import numpy as np


class UsageError(Exception):
    """Bad use or a bad input file: one line that names the file and the key or column."""


class Table:
    """A CSV file of numbers, read by header name. A line that does not fit raises UsageError.

    The first line names the columns, in any order. Every further line has one finite number per
    column.
    """

    def __init__(self, text, source):
        self.source = source
        header, *lines = text.split("\n")
        self.names = self._read_header(header)
        rows = [self._read_row(line, number) for number, line in enumerate(lines, 2)
                if line.strip(" \t\r")]
        if not rows:
            raise UsageError(f"{source}: no rows below the header")
        self.values = np.array(rows).T

    def _read_header(self, line):
        names = [cell.strip(" \t\r") for cell in line.split(",")]
        for place, name in enumerate(names):
            if not name:
                raise UsageError(f"{self.source}: line 1: a column has no name")
            if name in names[:place]:
                raise UsageError(f'{self.source}: line 1: column "{name}" appears twice')
        return names

    def _read_row(self, line, number):
        cells = line.split(",")
        if len(cells) != len(self.names):
            raise UsageError(f"{self.source}: line {number}: {len(cells)} values, but the header "
                             f"names {len(self.names)} columns")
        try:
            values = list(map(float, cells))
            if "_" not in line and isfinite(sum(values)):  # Python allows 1_000
                return values
        except ValueError:
            pass
        for name, cell in zip(self.names, cells):
            if fault := _fault_of(cell):
                raise UsageError(f'{self.source}: line {number}, column "{name}": '
                                 f'"{cell.strip()}" is {fault}')
        return values

    def __len__(self):
        return self.values.shape[1]

    def __contains__(self, name):
        return name in self.names

    def __getitem__(self, name):
        """Values of one column, top to bottom."""
        if name not in self.names:
            raise UsageError(f'{self.source}: column "{name}" is missing')
        return self.values[self.names.index(name)]

    def vectors(self, prefix):
        """Columns `prefix`_x, _y, _z, one row per line."""
        return np.column_stack([self[f"{prefix}_{axis}"] for axis in "xyz"])

    def norm(self, prefix):
        """Length of the vector in the columns `prefix`_x, _y, _z."""
        return np.linalg.norm(self.vectors(prefix), axis=1)


def _fault_of(cell):
    """Reason why a cell is not a number; empty if it is one."""
    try:
        value = float(cell)
    except ValueError:
        return "not a number"
    if "_" in cell:
        return "not a number"
    return "" if isfinite(value) else "not a finite number"


def read_text(path):
    """The whole file as text. Raises UsageError naming the file."""
    try:
        with open(path, encoding="utf-8", errors="replace", newline="") as file:
            return file.read()
    except OSError:
        raise UsageError(f"{path}: cannot be read; give folders that `tandem run --out` wrote") \
            from None


def read_table(path):
    return Table(read_text(path), path)
