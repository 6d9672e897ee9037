"""Maps of stability: growth as colour over two gains, and the border where it is none."""

import math

import numpy as np

from canvas import INNER, LEFT, PT, Figure, frame, line, points, set_axis, set_log_axis
from words import DIGITS, GAIN_LABELS, scheme_label

_MOST = 5.0  # colours end at this rate [1/s]
_COLOURS = "RdBu_r"
_BORDER = line("#000000", 2)
_HERE = points("#ffffff", "o", 9, markeredgecolor="#000000", markeredgewidth=2 * PT, zorder=5)


def axis_label(key):
    name, unit, _ = GAIN_LABELS[key]
    return f"{name} [{unit}]"


def _tic_text(factor, power):
    if power < 5:
        return f"{factor * 10.0 ** power:g}"
    return "3·" * (factor == 3) + f"10{str(power).translate(DIGITS)}"


def log_tics(low, high):
    """1 and 3 times powers of ten between two values."""
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    return {value: _tic_text(factor, power) for power in powers for factor in (1, 3)
            for value in [factor * 10.0 ** power] if low <= value <= high}


def _edges(values, is_logarithmic):
    """Borders of cells whose middles are `values`."""
    scale = np.log(values) if is_logarithmic else values
    middles = 0.5 * (scale[1:] + scale[:-1])
    edges = np.concatenate([[1.5 * scale[0] - 0.5 * scale[1]], middles,
                            [1.5 * scale[-1] - 0.5 * scale[-2]]])
    return np.exp(edges) if is_logarithmic else edges


def _set_gain_axis(axes, which, axis):
    factor = GAIN_LABELS[axis.key][2]
    low, high = factor * axis.values[0], factor * axis.values[-1]
    if axis.is_logarithmic:
        set_log_axis(axes, which, (low, high), log_tics(low, high))
    else:
        set_axis(axes, which, (low, high), 44)


def draw_map(axes, one):
    """Colours, border and the scenario's own values."""
    x, y = (GAIN_LABELS[axis.key][2] * axis.values for axis in (one.x, one.y))
    _set_gain_axis(axes, "x", one.x)
    _set_gain_axis(axes, "y", one.y)
    axes.grid(False)
    frame(axes)
    axes.pcolormesh(_edges(x, one.x.is_logarithmic), _edges(y, one.y.is_logarithmic), one.rates,
                    cmap=_COLOURS, vmin=-_MOST, vmax=_MOST, rasterized=True)
    if one.rates.min() < 0 < one.rates.max():
        axes.contour(x, y, one.rates, levels=[0.0], colors=[_BORDER["color"]],
                     linewidths=[_BORDER["linewidth"]])
    # A gain of 0 has no place on a logarithmic axis, and is marked at its end.
    here = [GAIN_LABELS[axis.key][2] * max(axis.value, axis.values[0]) for axis in (one.x, one.y)]
    axes.plot(here[:1], here[1:], clip_on=False, **_HERE)


def _draw_colours(sheet, left, top, height):
    """The scale of colours."""
    axes = sheet.panel(left, top, 16, height)
    frame(axes)
    axes.grid(False)
    rates = np.linspace(-_MOST, _MOST, 101)
    axes.pcolormesh([0, 1], rates, rates[1:, None], cmap=_COLOURS, rasterized=True)
    axes.set_xticks([])
    axes.yaxis.tick_right()
    axes.set_yticks([-_MOST, 0, _MOST], [f"≤ −{_MOST:g}", "0", f"≥ {_MOST:g}"])
    axes.set_title("rate [1/s]", pad=16 * PT)


def map_figure(atlas, name):
    """All maps of an atlas in a row; one alone is large."""
    count, gap, bar = len(atlas.maps), 84, 92
    height = 400 if count == 1 else 250
    width = (INNER - bar - gap * (count - 1)) / count if count > 1 else 690

    def paint(sheet):
        has_border = any(one.rates.min() < 0 < one.rates.max() for one in atlas.maps)
        sheet.legend([("border of stability", _BORDER)] * has_border +
                     [(f"{atlas.short_title}’s own values", _HERE)])
        for p, one in enumerate(atlas.maps):
            axes = sheet.panel(LEFT + p * (width + gap), 104, width, height,
                               scheme_label(one.scheme) if count > 1 else "",
                               axis_label(one.x.key), axis_label(one.y.key), 66)
            draw_map(axes, one)
        _draw_colours(sheet, LEFT + count * width + (count - 1) * gap + 28, 104, height)

    title = f"Growth of small motions: {atlas.short_title}"
    if count == 1:
        title += f", {scheme_label(atlas.maps[0].scheme)}"
    if atlas.users > 2:
        title += f", {atlas.users} users"
    return Figure(name, title,
                  "How fast a small motion grows while contact lasts, with empty hands. Blue: it "
                  "dies out; red: it grows. Colours end at 5 1/s both ways; all other gains are "
                  "the scenario’s. Ripples over the delay come with the packets’ period.",
                  104 + height + 62, paint)
