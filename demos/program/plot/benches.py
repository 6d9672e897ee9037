"""Figures of `tandem bench`, drawn from the JSON file that each bench writes."""

import math

from matplotlib.colors import ListedColormap

from canvas import LEFT, PT, Figure, line, points, set_log_axis
from runs import parse_object
from table import read_text
from words import DIGITS

# Looks of ways to simulate: colour, marker, and "none" for a hollow one; equal in all figures.
_METHODS = {
    "plugin handoff": ("#0072b2", "o"), "plugin handoff, late": ("#56b4e9", "o", "none"),
    "plugin impulse": ("#009e73", "s"), "force injection": ("#e69f00", "^"),
    "small Bullet world": ("#000000", "d"),
    "Bullet rigid": ("#999999", "+"), "Bullet soft": ("#d55e00", "v"),
    "Bullet 6DofSpring2": ("#cc79a7", "<"), "Bullet Point2Point": ("#8c564b", "D"),
    "MuJoCo": ("#9467bd", "*"), "ODE": ("#17becf", "x"), "Simbody": ("#bcbd22", "p")}
_WAYS = {"Bullet 60 Hz": ("#999999", "o", "none"), "Bullet 240 Hz": ("#e69f00", "D"),
         "whole world 1 kHz": ("#d55e00", "s"), "Bullet 60 Hz + island": ("#0072b2", "^")}
_CELLS = {"stable": ("#56b4e9", "comes to rest"), "grows": ("#e69f00", "grows"),
          "not_finite": ("#a50f15", "not finite")}


def bench_figures(path):
    """The figures that belong to accuracy.json, speed.json or stress.json."""
    bench = parse_object(read_text(path), path)
    return {"tandem-bench-accuracy": _accuracy_figures, "tandem-bench-speed": _speed_figures,
            "tandem-bench-stress": _stability_figures}[bench["format"]](bench)


def _looks(colour, marker, fill=None):
    return line(colour, 1.6) | points(colour, marker, 6, linestyle="-", markeredgewidth=1.2 * PT,
                                      markerfacecolor=fill or colour)


def _decades(values):
    """Powers of ten around all values, and tics at most of them."""
    low = math.floor(math.log10(min(values)) - 0.1)
    high = math.ceil(math.log10(max(values)) + 0.1)
    step = max(1, -(-(high - low) // 6))
    return (10.0 ** low, 10.0 ** high), {
        10.0 ** power: f"10{str(power).translate(DIGITS)}" for power in range(low, high + 1, step)}


def _accuracy_figures(bench):
    """Run time against error, a panel for each scene."""
    floor = 1e-11  # errors below this are rounding, and are drawn there
    caption = ("Each line is a method, its points the host’s step rates, slower ones to the left. "
               "Left and below is better; rates at which a method diverges have no point.")

    def make(name, title, label, value):
        shown = []  # per scene: its title, and by method the run times and the errors
        for scene in bench["scenes"]:
            curves = {}
            for run in scene["runs"]:
                if run["status"] == "good" and value(run["errors"]) > 0:
                    error = max(value(run["errors"]), floor)
                    curves.setdefault(run["method"], []).append((run["us_per_second"], error))
            if curves:
                shown.append((scene["title"], curves))
        methods = list(dict.fromkeys(method for _, curves in shown for method in curves))
        methods.sort(key=lambda method: list(_METHODS).index(method) if method in _METHODS else 99)
        looks = {method: _looks(*_METHODS.get(method, ("#000000", "."))) for method in methods}
        top = 66 + 26 * math.ceil(len(methods) / 4)

        def paint(sheet):
            entries = [(method, look) for method, look in looks.items()]
            for first in range(0, len(entries), 4):
                sheet.legend(entries[first:first + 4], 51 + 26 * first // 4)
            times = _decades([x for _, curves in shown for rows in curves.values()
                              for x, _ in rows])
            for p, (title, curves) in enumerate(shown):
                axes = sheet.panel(LEFT + p % 3 * 288, top + p // 3 * 250, 226, 176, title,
                                   "run time per simulated second [µs]"
                                   if p + 3 >= len(shown) else "", "" if p % 3 else label)
                set_log_axis(axes, "x", *times)
                set_log_axis(axes, "y", *_decades([y for rows in curves.values()
                                                   for _, y in rows]))
                for method in methods:
                    if method in curves:
                        axes.plot(*zip(*curves[method]), **looks[method])

        if shown:
            yield Figure(name, title, caption, top + 250 * math.ceil(len(shown) / 3), paint)

    return [*make("accuracy", "Run time against position error", "largest position error [mm]",
                  lambda errors: 1e3 * max(errors["tool"], errors["body"])),
            *make("accuracy_force", "Run time against force error", "largest force error [N]",
                  lambda errors: errors["force"])]


def _time_text(us):
    return next(f"{us / scale:g} {unit}" for scale, unit in ((1e6, "s"), (1e3, "ms"), (1, "µs"))
                if us >= scale)


def _speed_figures(bench):
    """Run time against the size of the world."""
    panels = [  # title, what is counted, what the hand touches, whether the boxes are awake
        ("active boxes, cube pressed", "bodies", "cube", True),
        ("sleeping boxes, cube pressed", "bodies", "cube", False),
        ("many shared, one pressed", "objects", "cube", False),
        ("many shared, none touched", "objects", "nothing", False)]

    def cases_of(_, count, touch, awake):
        # Sweeps over objects are in a world of their own size, and those over users in the table.
        return [case for case in bench["cases"] if case["touch"] == touch and
                case["awake"] == awake and "users" not in case["name"] and
                ("shared" in case["name"]) == (count == "objects")]

    def paint(sheet):
        looks = {way: _looks(*look) for way, look in _WAYS.items()}
        sheet.legend(list(looks.items()), 51)
        spent = [result["us_per_second"] for panel in panels for case in cases_of(*panel)
                 for result in case["results"]]
        low, high = math.floor(math.log10(min(spent))), math.ceil(math.log10(max(spent)))
        times = {10.0 ** power: _time_text(10 ** power) for power in range(low, high + 1)}
        for p, panel in enumerate(panels):
            cases, count = cases_of(*panel), panel[1]
            axes = sheet.panel(96 + p % 2 * 414, 90 + p // 2 * 292, 340, 210, panel[0],
                               "shared objects" if count == "objects" else "boxes of the host",
                               "" if p % 2 else "run time per simulated second", 80)
            sizes = {case[count]: str(case[count]) for case in cases}
            set_log_axis(axes, "x", (0.8 if count == "objects" else 1.5, 1.4 * max(sizes)), sizes)
            set_log_axis(axes, "y", (0.999 * 10.0 ** low, 1.001 * 10.0 ** high), times)
            axes.axhline(1e6, **line("#bbbbbb", 1.4, (5, 4)))
            for way, look in looks.items():
                rows = [(case[count], result["us_per_second"]) for case in cases
                        for result in case["results"] if result["way"] == way]
                axes.plot([x for x, _ in rows], [y for _, y in rows], **look)

    return [Figure("speed", "Run time against the size of the world",
                   "Lower is better. Above the dashed line a processor core cannot keep up. Bullet "
                   "alone feels no hand; it is there to compare with.", 674, paint)]


def _stability_figures(bench):
    """Stiffness against host step, a panel for each way to simulate."""
    maps = bench["maps"]

    def edges(values):
        """Borders between values of a logarithmic grid."""
        half = (values[-1] / values[0]) ** (0.5 / (len(values) - 1))
        return [values[0] / half, *(value * half for value in values)]

    def paint(sheet):
        limit, names = line("#000000", 2), list(_CELLS)
        colours = ListedColormap([colour for colour, _ in _CELLS.values()])
        sheet.legend([(text, points(colour, "s", 12)) for colour, text in _CELLS.values()] +
                     [("limit of injection by analysis", limit)], 49)
        for p, one in enumerate(maps):
            axes = sheet.panel(LEFT + p % 3 * 280, 92 + p // 3 * 304, 240, 230, one["method"],
                               "host step [ms]" if p + 3 >= len(maps) else "",
                               "" if p % 3 else "stiffness of contact and coupler [N/m]")
            steps = [1e3 / rate for rate in one["host_rates"]]
            x, y = edges(steps), edges(one["stiffness"])
            set_log_axis(axes, "x", (min(x), max(x)), {t: f"{t}" for t in (1, 2, 5, 10, 20, 33)})
            set_log_axis(axes, "y", (y[0], y[-1]), {
                10.0 ** power: "" if p % 3 else str(10 ** power) if power < 3 else
                f"10{str(power).translate(DIGITS)}" for power in range(1, 7)})
            axes.grid(False)
            kinds = [[names.index(cell) if cell in names else math.nan for cell in row]
                     for row in one["cells"]]
            axes.pcolormesh(x, y, kinds, cmap=colours, vmin=0, vmax=len(names) - 1)
            if "step_limit" in one:
                axes.plot([1e3 * step for step in one["step_limit"]], one["stiffness"], **limit)

    return [Figure("stability", "Stability: stiffness against host step",
                   "A sphere of 0.1 kg, held by a coupler to a target inside a fixed cube, is "
                   "released above it. Grows: in the second half it has more energy than it was "
                   "released with.", 92 + 304 * math.ceil(len(maps) / 3), paint)]
