"""Figures that compare schemes: distance of the two copies, and sweeps over device damping."""

import math

import numpy as np

from canvas import INNER, LEFT, PT, Figure, line, nice_step, points, set_axis, set_log_axis, span
from findings import INTERMITTENT_CHANGES, MEASURES, changes_of, changes_text
from paper import paper_outcome
from run_figures import recorded_time
from runs import CONTACT, separation
from words import number_text, scheme_colour, scheme_label, scheme_marker

_PAPER_MARK = points("#000000", "s", 7, markerfacecolor="none", markeredgewidth=1.6 * PT)


def coherency_bars(group, name):
    """Mean distance between the copies by scheme. Where settings are the paper's, so is a mark."""
    def paint(sheet):
        legend = [(scheme_label(run.scheme), points(scheme_colour(run.scheme), "s", 12))
                  for run in group.runs]
        if any(paper_outcome(run) for run in group.runs):
            legend.append(("the paper’s equations", _PAPER_MARK))
        sheet.legend(legend)
        axes = sheet.panel(LEFT, 80, INNER, 312, y_label="mean distance [mm]")
        width, highest = 0.8 / len(group.runs), 0.0
        for s, run in enumerate(group.runs):
            for m, key in enumerate(MEASURES.values()):
                x, value = m - 0.4 + width * (s + 0.5), run.number(key) * 1e3
                if not math.isfinite(value):
                    continue
                highest = max(highest, value)
                axes.bar(x, value, 0.9 * width, color=scheme_colour(run.scheme))
                axes.annotate(number_text(value), (x, value), (0, 10 * PT), ha="center",
                              textcoords="offset points")
                mark = paper_outcome(run).get(key, math.nan) * 1e3
                axes.plot([x], [mark], **_PAPER_MARK)
        set_axis(axes, "y", (0, 1.15 * highest or 1.0), 50)
        axes.set_xlim(-0.55, 2.55)
        axes.set_xticks(range(3), ["both at equal time", "own and received, site 1",
                                   "own and received, site 2"])
        axes.tick_params(axis="x", length=0)
        axes.grid(False, axis="x")

    return Figure(
        name, "Distance between the two copies of the object, by scheme",
        "How far apart the two copies are on average: both at the same instant, and each site’s "
        "own copy against the other copy as it arrives there over the network. Lower is better.",
        432, paint)


def coherency_over_time(runs, name):
    """Distance between the two object copies over time, schemes in one panel."""
    title = "Distance between the two copies of the object over time"
    if len(runs) == 1:
        title += f" ({scheme_label(runs[0].scheme)})"

    def paint(sheet):
        looks = {run.scheme: line(scheme_colour(run.scheme), 2) for run in runs}
        if len(runs) > 1:
            sheet.legend([(scheme_label(scheme), look) for scheme, look in looks.items()])
        axes = sheet.panel(LEFT, 80, INNER, 280, "", "time [s]", "|object 1 − object 2| [mm]")
        times, highest = [], 1e-3
        for run in runs:
            tables = run.tables()
            distance = 1e3 * separation(tables)
            axes.plot(tables[0]["t"][:len(distance)], distance, **looks[run.scheme])
            times += recorded_time(tables[0]["t"])
            highest = max(highest, np.nanmax(distance, initial=0.0))
        set_axis(axes, "x", (min(times), max(times)), 110)
        set_axis(axes, "y", (0, 1.08 * highest), 34)

    return Figure(name, title, "Both copies at the same instant: the distance is zero when the "
                  "users share one object.", 424, paint)


def sweep_figure(sweep, name):
    """Outcome against the device's own damping, a line per scheme."""
    is_contact = sweep.kind == CONTACT
    if is_contact:
        panels = [("contact of user 1: on/off changes", "changes (log scale)", changes_of),
                  ("largest force on user 1", "force [N]",
                   lambda run: run.number("site1.force.max"))]
    else:
        panels = [(measure, "[mm]" if p else "mean distance of copies [mm]",
                   lambda run, key=key: run.number(key) * 1e3)
                  for p, (measure, key) in enumerate(MEASURES.items())]
    threshold = line("#000000", 1.2, (3, 2))

    def paint(sheet):
        looks = {scheme: line(scheme_colour(scheme), 2) |
                 {"marker": scheme_marker(scheme), "markersize": 9 * PT, "markeredgewidth": 0}
                 for scheme in sweep.schemes}
        legend = [(scheme_label(scheme), look) for scheme, look in looks.items()]
        if is_contact:
            legend.append((changes_text(INTERMITTENT_CHANGES), threshold))
        sheet.legend(legend)
        gap = 66
        width = (INNER - gap * (len(panels) - 1)) / len(panels)
        for p, (title, label, value) in enumerate(panels):
            axes = sheet.panel(LEFT + p * (width + gap), 100, width, 268, title,
                               "device damping b_dev [N s/m]", label, 46 if p else 56)
            highest = 0.0
            for scheme, look in looks.items():
                rows = [(point.damping, value(run)) for point in sweep.points
                        for run in [point.find(scheme)] if run and math.isfinite(value(run))]
                highest = max([highest, *(y for _, y in rows)])
                axes.plot([x for x, _ in rows], [y for _, y in rows], clip_on=False, **look)
            set_axis(axes, "x", span([point.damping for point in sweep.points], share=0.05), 50)
            if is_contact and p == 0:
                axes.axhline(INTERMITTENT_CHANGES, **threshold)
                tics = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
                set_log_axis(axes, "y", (0.8, max(2 * highest, 30.0)),
                             {tic: f"{tic}" for tic in tics if tic <= max(2 * highest, 30.0)})
            else:
                step = nice_step(highest or 1.0, 8)
                set_axis(axes, "y", (0, step * math.ceil((highest or 1.0) / step)), 33)

    return Figure(
        name, "User-to-user contact against the device’s own damping" if is_contact else
        "Distance between the object copies against device damping",
        "How often contact goes on or off, and the largest force, for each damping of the real "
        "device. One change means that the first touch is kept; the dashed line is where this "
        "report begins to call contact intermittent." if is_contact else
        "Mean distance between the two copies for each damping of the real device, which the "
        "paper does not give: both copies at equal time, and each site’s own copy against the "
        "other as received there.", 432, paint)
