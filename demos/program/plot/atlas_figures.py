"""Curves of stability: damping that is needed, users, criteria, and fine steps of the delay."""

import numpy as np

from atlas_maps import log_tics, map_figure
from canvas import INNER, LEFT, PT, Figure, line, set_axis, set_log_axis, span
from words import scheme_colour, scheme_label, scheme_marker

_DASH = (6, 4)
_DASHES = (None, _DASH, (2, 3))  # of the first, second and third scenario
_ZERO = line("#000000", 1.2)
_OWN = line("#777777", 1.4, (2, 3))  # the scenario's own value


def _looks(scheme, dash=None):
    return line(scheme_colour(scheme), 2, dash)


def damping_figure(atlases, name):
    """Damping of devices with which each scheme is stable, over the delay; all scenarios in one."""
    def paint(sheet):
        rows = [(atlas, scheme, atlas.curves["damping"].x, values)
                for atlas in atlases for scheme, values in atlas.curves["damping"].curves.items()]
        looks = {}
        axes = sheet.panel(LEFT, 116, INNER, 280, "", "delay T_d [ms]", "b_dev needed [N s/m]")
        for atlas, scheme, x, values in rows:
            label = scheme_label(scheme)
            if len(atlases) > 1:
                label = f"{atlas.short_title}, {label}"
            looks[label] = _looks(scheme, _DASHES[atlases.index(atlas) % len(_DASHES)])
            axes.plot(1e3 * x, values, **looks[label])
        for damping in {atlas.gains["device.damping"] for atlas in atlases}:
            axes.axhline(damping, **_OWN)
        sheet.legend([*looks.items(), ("b_dev of the scenario", _OWN)], 66)
        set_axis(axes, "x", span(*(1e3 * x for _, _, x, _ in rows), share=0.0), 60)
        set_axis(axes, "y", (0, 1.08 * max(1.0, *(np.nanmax(values, initial=0.0)
                                                 for *_, values in rows))), 34)

    return Figure(name, "Damping of the devices that stability needs",
                  "The least damping of both devices with which small motions die out while "
                  "contact lasts, with empty hands. Above a curve its scheme is stable.", 454,
                  paint)


_USER_LABELS = {"sum": "sum", "average": "average", "average_whole": "average, whole proxies"}
_USER_DASHES = {"sum": None, "average": _DASH, "average_whole": (2, 3)}


def users_figure(atlas, name):
    """Rates over the number of users, by scheme and by how copies are coordinated."""
    def paint(sheet):
        curves = atlas.curves["users"]
        axes = sheet.panel(LEFT, 116, INNER, 280, "", "users N", "rate [1/s]")
        looks = {}
        for key, values in curves.curves.items():
            scheme, way = key.split("/")
            label = f"{scheme_label(scheme)}, {_USER_LABELS[way]}"
            looks[label] = _looks(scheme, _USER_DASHES[way]) | {
                "marker": scheme_marker(scheme), "markersize": 7 * PT, "markeredgewidth": 0}
            axes.plot(curves.x, values, clip_on=False, **looks[label])
        axes.axhline(0.0, **_ZERO)
        sheet.legend(list(looks.items()), 66)
        axes.set_xlim(curves.x[0] - 0.5, curves.x[-1] + 0.5)
        axes.set_xticks(curves.x, [f"{count:g}" for count in curves.x])
        set_axis(axes, "y", span(*curves.curves.values(), [0.0]), 34)

    delay = 1e3 * atlas.gains["network.delay"]
    ways = ("By the sum each copy is tied to all others whole; by average to their mean, and a "
            "proxy is 1/(N−1) of a user. Whole: with whole proxies." if atlas.has_object else
            "By the sum each other user is felt whole, by average as 1/(N−1) of one.")
    return Figure(name, f"More users at a delay of {delay:g} ms: {atlas.short_title}",
                  "Growth of small motions while all hold their devices (300 N/m, 5 N s/m). "
                  + ways, 454, paint)


# In the order of drawing: label and looks of a border and of criteria for it.
_LIMITS = {
    "exact": ("exact", line("#000000", 2)),
    "chain": ("masses and delayed couplers", line("#0072b2", 2)),
    "every_delay": ("the same, at every delay", line("#0072b2", 2, _DASH)),
    "grounded_damper": ("b ≥ K τ (P+d)", line("#d55e00", 2)),
    "wall": ("K T/2 < B + b", line("#009e73", 2)),
    "colgate_schenkel": ("b > K T/2 + B (Colgate–Schenkel)", line("#cc79a7", 2))}
_LIMIT_TITLES = {"coordination_limits": "coordination stiffness K_t, virtual coupling",
                 "contact_limits": "contact stiffness K_vc"}


def limits_figure(atlas, name):
    """The exact border of a stiffness over the delay, beside textbook criteria."""
    panels = [key for key in _LIMIT_TITLES if key in atlas.curves]
    scheme = "virtual coupling" if atlas.has_object else "kinematic proxy"
    gap = 90
    width = (INNER - gap * (len(panels) - 1)) / len(panels)

    def paint(sheet):
        shown = {}
        for p, key in enumerate(panels):
            curves = atlas.curves[key]
            title = _LIMIT_TITLES[key] + (f", {scheme}" if key == "contact_limits" else "")
            axes = sheet.panel(LEFT + p * (width + gap), 140, width, 300, title, "delay T_d [ms]",
                               "largest stiffness [N/m]", 66)
            values = np.concatenate([one[np.isfinite(one)] for one in curves.curves.values()])
            low, high = 0.7 * values.min(), 1.5 * values.max()
            set_log_axis(axes, "y", (low, high), log_tics(low, high))
            set_axis(axes, "x", span(1e3 * curves.x, share=0.0), 60)
            for kind, one in curves.curves.items():
                label, looks = _LIMITS[kind]
                if not np.isfinite(one).any():
                    label += ": allows none"
                shown[kind] = label, looks
                axes.plot(1e3 * curves.x, one, zorder=3 if kind == "exact" else 2, **looks)
        sheet.legend([shown[kind] for kind in _LIMITS if kind in shown], 76)

    return Figure(name, f"The exact border beside textbook criteria: {atlas.short_title}",
                  "The largest stiffness that is stable with empty hands, by the exact analysis "
                  "and by criteria. B: damping of the coupler, b: of the device, T: haptic period, τ: "
                  "delay and half a packet.", 498, paint)


def fine_figure(atlases, name):
    """Rates in small steps of the delay: a panel for each scheme."""
    panels = [(atlas, scheme) for atlas in atlases for scheme in atlas.curves["fine"].curves]
    columns = 3 if len(panels) != 4 else 2
    gap, height, top = 66, 200, 104 if len(atlases) == 1 else 122
    row = height + 90 + (top - 104)
    width = (INNER - gap * (columns - 1)) / columns

    def paint(sheet):
        sheet.legend([("border", _ZERO), ("the scenario’s own delay", _OWN)], 55)
        for p, (atlas, scheme) in enumerate(panels):
            curves = atlas.curves["fine"]
            title = scheme_label(scheme)
            if len(atlases) > 1:
                title = f"{atlas.short_title}\n{title}"
            axes = sheet.panel(LEFT + p % columns * (width + gap), top + p // columns * row,
                               width, height, title, "delay T_d [ms]",
                               "" if p % columns else "rate [1/s]")
            values = curves.curves[scheme]
            axes.plot(1e3 * curves.x, values, **_looks(scheme))
            low, high = span(values)
            if low < 0 < high:
                axes.axhline(0.0, **_ZERO)
            axes.axvline(1e3 * atlas.gains["network.delay"], **_OWN)
            set_axis(axes, "x", span(1e3 * curves.x, share=0.0), 50)
            set_axis(axes, "y", (low, high), 34)

    return Figure(name, "Growth in delay steps of 0.25 ms",
                  "Packets arrive between ticks, and a millisecond changes how long a tick waits "
                  "for them. So borders of the delay are no intervals: leave a margin of a packet.",
                  top - 24 + row * -(-len(panels) // columns), paint)


_STIFFNESSES = ("#9ecae1", "#4292c6", "#08519c", "#08306b")  # from the softest on


def touch_figure(atlas, name):
    """What a touch of a kinematic proxy leaves of the speed, over the damping of the device."""
    def paint(sheet):
        curves = atlas.curves["touch"]
        axes = sheet.panel(LEFT, 96, INNER, 280, "", "b_dev [N s/m]", "speed after / before")
        looks = {}
        for colour, (stiffness, values) in zip(_STIFFNESSES, curves.curves.items()):
            label = f"K_vc = {stiffness} N/m"
            looks[label] = line(colour, 2)
            axes.plot(curves.x, values, **looks[label])
        axes.axhline(1.0, **_ZERO)
        damping = atlas.gains["device.damping"]
        if damping <= curves.x[-1]:
            axes.axvline(damping, **_OWN)
        sheet.legend([*looks.items(), ("gains energy above", _ZERO), ("b_dev of the scenario", _OWN)],
                     66)
        set_axis(axes, "x", span(curves.x, share=0.0), 60)
        set_axis(axes, "y", span(*curves.curves.values(), [1.0]), 34)

    return Figure(name, f"A touch of a kinematic proxy: {atlas.short_title}",
                  "The part of its speed that an empty hand keeps in one touch of a user who does not "
                  "answer yet. Near 1 contact comes and goes many times until it rests.", 434, paint)


def atlas_figures(atlas):
    """The figures of one folder, named for its files."""
    figures = [map_figure(atlas, "map")]
    makers = (("damping", lambda: damping_figure([atlas], "damping")),
              ("users", lambda: users_figure(atlas, "users")),
              ("contact_limits", lambda: limits_figure(atlas, "limits")),
              ("fine", lambda: fine_figure([atlas], "fine")),
              ("touch", lambda: touch_figure(atlas, "touch")))
    return figures + [make() for key, make in makers if key in atlas.curves]
