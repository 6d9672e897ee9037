"""What `tandem analyse --map` or `--figures` left in a folder: maps of stability, and curves."""

import os
from dataclasses import dataclass

import numpy as np

from runs import NAN, Summary, parse_object
from table import UsageError, read_table, read_text
from words import GAIN_LABELS, join_words

MARK = "stability.json"
_FORMAT = "tandem-stability"


@dataclass
class Axis:
    """A gain along one side of a map; values in SI."""
    key: str
    is_logarithmic: bool
    values: np.ndarray
    value: float  # of the scenario


@dataclass
class Map:
    """Growth rates [1/s] of a scheme over two gains: a row for each y, a column for each x."""
    scheme: str
    x: Axis
    y: Axis
    rates: np.ndarray


@dataclass
class Curves:
    """Curves by name over the same numbers; NaN where there is nothing."""
    x: np.ndarray
    curves: dict


@dataclass
class Atlas:
    """Maps and curves of one scenario."""
    title: str
    users: int
    has_object: bool
    gains: dict  # values of the scenario by key, in SI
    maps: list
    curves: dict  # of figures, by name

    @property
    def short_title(self):
        """ "Experiment I" for "Experiment I: cooperative manipulation" """
        short = self.title.split(":")[0]
        return short if len(short) <= 32 else short[:31] + "…"


def is_atlas(folder):
    """True if `tandem analyse` has written to this folder, and no `tandem run`."""
    return os.path.exists(os.path.join(folder, MARK)) and \
        not os.path.exists(os.path.join(folder, "summary.json"))


def _read_map(summary, at, folder):
    source = os.path.join(folder, os.path.basename(summary.text(f"{at}.file")))
    table = read_table(source)
    keys = [summary.text(f"{at}.{side}.key") for side in "xy"]
    for side, key in zip("xy", keys):
        if key not in GAIN_LABELS:
            summary.refuse(f"{at}.{side}.key", f'is "{key}"; allowed are {join_words([*GAIN_LABELS])}')
    columns, rows = (round(summary.number(f"{at}.{side}.points")) for side in "xy")
    if len(table) != columns * rows:
        raise UsageError(f"{source}: {len(table)} points, but {MARK} tells of {columns} x {rows}")
    x, y, rates = (table[name].reshape(rows, columns) for name in (*keys, "rate"))
    axes = [Axis(key, key != "network.delay", values, summary.number(f"{at}.{side}.value"))
            for side, key, values in (("x", keys[0], x[0]), ("y", keys[1], y[:, 0]))]
    return Map(summary.text(f"{at}.scheme"), *axes, rates)


def _read_curves(root):
    def numbers(values):
        return np.array([NAN if value is None else float(value) for value in values])
    return Curves(numbers(root["x"]), {curve["name"]: numbers(curve["values"])
                                       for curve in root["curves"]})


def load_atlas(folder):
    """Reads stability.json of `folder` and its maps."""
    path = os.path.join(folder, MARK)
    root = parse_object(read_text(path), path)
    summary = Summary(root, path)
    if summary.text("format") != _FORMAT:
        summary.refuse("format", f"is not {_FORMAT}")
    maps = [_read_map(summary, f"maps.{place}", folder)
            for place in range(len(summary.get("maps", list, "list")))]
    try:
        curves = {name: _read_curves(one) for name, one in root["curves"].items()}
        gains = {key: float(value) for key, value in root["gains"].items()}
    except (KeyError, TypeError, ValueError, AttributeError):
        raise UsageError(f"{path}: curves or gains are damaged; analyse again") from None
    return Atlas(summary.text("title"), round(summary.number("users")),
                 root.get("has_object") is True, gains, maps, curves)
