"""Drawing of figures: panels placed by pixel, one row of legend, SVG and PNG files."""

import logging
import math
import os
from dataclasses import dataclass
from typing import Callable

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure as Drawing
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, MultipleLocator, NullLocator

WIDTH = 900  # of every figure [px]
LEFT, INNER = 82, 802  # where panels begin, and the width of all of them together [px]
PT = 0.75  # one pixel in points
_PNG_DPI = 144  # 1.5 pixels of the file for one of the layout
_TEXT = 13.5 * PT
_GREY = "#555555"

logging.getLogger("matplotlib").setLevel(logging.ERROR)  # such as a cache that is being made
matplotlib.rcdefaults()  # whatever the user's own file says
matplotlib.rcParams.update({
    "svg.fonttype": "none", "svg.hashsalt": "tandem", "text.parse_math": False,
    "font.family": ["DejaVu Sans", "sans-serif"], "font.size": _TEXT, "lines.scale_dashes": False,
    "axes.axisbelow": True, "axes.edgecolor": _GREY, "axes.linewidth": 1.2 * PT,
    "axes.spines.top": False, "axes.spines.right": False, "axes.titlesize": _TEXT,
    "axes.titlepad": 7 * PT, "axes.titley": 1.0, "axes.grid": True,
    "grid.color": "#dddddd", "grid.linewidth": 0.8 * PT,
    "xtick.color": _GREY, "ytick.color": _GREY, "xtick.major.size": 5 * PT,
    "ytick.major.size": 5 * PT, "xtick.major.width": PT, "ytick.major.width": PT,
    "xtick.major.pad": 8 * PT, "ytick.major.pad": 8 * PT, "path.simplify_threshold": 0.2})

_PLAIN = FuncFormatter(lambda value, place: f"{value + 0.0:g}")
_NO_TEXT = FuncFormatter(lambda value, place: "")


@dataclass
class Figure:
    """A picture of the report. `paint` draws it on a Sheet."""
    name: str  # of the files, without extension
    title: str
    caption: str
    height: float  # [px]
    paint: Callable

    suffix = ".svg"  # of the file that the report shows
    width = WIDTH

    def save(self, folder):
        """Writes NAME.svg and NAME.png."""
        path = os.path.join(folder, self.name)
        sheet = Sheet(self.title, self.height)
        self.paint(sheet)
        sheet.drawing.savefig(f"{path}.svg", metadata={"Date": None})
        sheet.drawing.savefig(f"{path}.png", dpi=_PNG_DPI)


def line(colour, width=1.8, dash=None):
    """Looks of a line; width and the dash's lengths in pixels."""
    style = "-" if dash is None else (0, tuple(length * PT for length in dash))
    return {"color": colour, "linewidth": width * PT, "linestyle": style}


def points(colour, marker, size=7, **more):
    return {"color": colour, "marker": marker, "markersize": size * PT, "linestyle": "none",
            "markeredgewidth": 1.4 * PT if marker in "x+*" else 0} | more


def nice_step(size, parts):
    """1, 2 or 5 times a power of ten: the least that cuts `size` into at most `parts` parts."""
    raw = size / parts
    power = 10.0 ** math.floor(math.log10(raw))
    return next(factor * power for factor in (1, 2, 5, 10) if factor * power >= 0.999 * raw)


def span(*arrays, share=0.06, least=0.0):
    """Limits around all finite values, grown by `share` at both ends, and to `least` at least."""
    values = np.concatenate([np.atleast_1d(np.asarray(array, float)) for array in arrays])
    values = values[np.isfinite(values)]
    if not len(values):
        return 0.0, 1.0
    low, high = values.min(), values.max()
    grow = share * (high - low) if high > low else max(0.1 * abs(low), 1e-3)
    grow = max(grow, 0.5 * (least - (high - low)))
    return low - grow, high + grow


class Sheet:
    """One figure on which panels are placed in pixels, y downwards from the top."""

    def __init__(self, title, height):
        self.height = height
        self.drawing = Drawing(figsize=(WIDTH / 96, height / 96))
        FigureCanvasAgg(self.drawing)
        self.drawing.text(0.5, 1 - 19 / height, title, ha="center", va="center", size=16.5 * PT)

    def panel(self, left, top, width, height, title="", x_label="", y_label="", y_out=56):
        """Axes at that place. The label of the axis of values stands `y_out` pixels to the left."""
        axes = self.drawing.add_axes((left / WIDTH, 1 - (top + height) / self.height,
                                      width / WIDTH, height / self.height))
        if title:
            axes.set_title(title)
        if x_label:
            axes.set_xlabel(x_label, va="center")
            axes.xaxis.set_label_coords(0.5, -45 / height)
        if y_label:
            axes.set_ylabel(y_label, va="center")
            axes.yaxis.set_label_coords(-y_out / width, 0.5)
        axes.pixels = {"x": width, "y": height}
        return axes

    def legend(self, entries, y=55):
        """Centred rows of at most eight: pairs of a text and the looks of a Line2D."""
        for rows in range(math.ceil(len(entries) / 8), len(entries) + 1):
            legend = self._draw_legend(entries, y, math.ceil(len(entries) / rows))
            place = legend.get_window_extent(self.drawing.canvas.get_renderer())
            if place.x0 >= 0 and place.x1 <= self.drawing.bbox.width:
                return
            legend.remove()
        self._draw_legend(entries, y, 1)

    def _draw_legend(self, entries, y, columns):
        is_crowded = len(entries) > 6
        handles = [Line2D([], [], **looks) for _, looks in entries]
        return self.drawing.legend(
            handles, [text for text, _ in entries], loc="center", ncol=columns,
            bbox_to_anchor=((LEFT + INNER / 2) / WIDTH, 1 - y / self.height), frameon=False,
            handlelength=1.6 if is_crowded else 2.4, handletextpad=0.6,
            columnspacing=1.2 if is_crowded else 1.8, borderpad=0)


def frame(axes):
    """Lines on all four sides."""
    axes.spines[["top", "right"]].set_visible(True)


def set_axis(axes, which, limits, gap=40, shows_text=True):
    """Limits and tics at round values, at least about `gap` pixels apart."""
    low, high = limits
    axis = axes.xaxis if which == "x" else axes.yaxis
    (axes.set_xlim if which == "x" else axes.set_ylim)(low, high)
    axis.set_major_locator(MultipleLocator(nice_step(high - low, axes.pixels[which] / gap)))
    axis.set_major_formatter(_PLAIN if shows_text else _NO_TEXT)


def set_log_axis(axes, which, limits, tics):
    """A logarithmic axis with the tics of a dictionary: value to text."""
    axis = axes.xaxis if which == "x" else axes.yaxis
    (axes.set_xscale if which == "x" else axes.set_yscale)("log")
    (axes.set_xlim if which == "x" else axes.set_ylim)(*limits)
    axis.set_minor_locator(NullLocator())
    axis.set_ticks(list(tics), list(tics.values()))
