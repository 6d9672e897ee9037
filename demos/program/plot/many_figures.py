"""Figures of runs with more than two sites."""

import math

import numpy as np

from canvas import INNER, LEFT, PT, Figure, frame, line, set_axis, span
from many_runs import coupler_drag, label_of
from run_figures import recorded_time
from words import scheme_colour, scheme_marker, user_colour

_DASH = (5, 4)
_TOP, _GAP = 112, 26  # [px]


def _looks(user):
    """Users 9 to 16 have the colours of 1 to 8, dashed. Later curves are thinner, so that those
    of users who do the same are seen behind each other."""
    return line(user_colour(user), max(1.2, 5 - 0.5 * user), None if user <= 8 else _DASH)


def _users(run):
    return range(1, run.sites + 1)


def many_motion(run, name):
    """Positions of all users and copies over time, and forces on all users."""
    def signals(tables):
        rows = min(len(table["t"]) for table in tables)  # sites of a live run differ by a few
        yield "devices, x [mm]", 210, [1e3 * table["device_x"] for table in tables]
        if run.has_object:
            copies = [1e3 * table["object_x"][:rows] for table in tables]
            mean = np.mean(copies, axis=0)
            yield "copies from mean [mm]", 170, [copy - mean for copy in copies]
        yield "force [N]", 170, [table.norm("force") for table in tables]

    height = _TOP + 210 + 170 + _GAP + 58 + ((170 + _GAP) if run.has_object else 0)

    def paint(sheet):
        sheet.legend([(f"user {user}", _looks(user)) for user in _users(run)], y=62)
        tables, top = run.tables(), _TOP
        t = tables[0]["t"]
        rows = list(signals(tables))
        for row, (label, panel, curves) in enumerate(rows):
            is_last = row + 1 == len(rows)
            axes = sheet.panel(LEFT, top, INNER, panel, "", "time [s]" if is_last else "", label)
            for user, curve in zip(_users(run), curves):
                shown = min(len(t), len(curve))
                axes.plot(t[:shown], curve[:shown], **_looks(user))
            set_axis(axes, "x", recorded_time(t), 110, is_last)
            set_axis(axes, "y", span(*curves, least=0.2), 30)
            top += panel + _GAP

    return Figure(
        name, f"{run.sites} users over time ({label_of(run)})",
        "Displacement of each user’s device from its start, of each site’s copy of the object from "
        "the mean of all copies, and the size of the force on each user. Curves of users who do "
        "the same lie on each other, the first ones wider.", height, paint)


def _matrix_of_pairs(run):
    """Mean distance of the copies of each two sites [mm]."""
    matrix = np.full((run.sites, run.sites), np.nan)
    for at in range(run.sites * (run.sites - 1) // 2):
        i, j = (int(run.number(f"coherency.pairs.{at}.{key}")) - 1 for key in "ij")
        matrix[i, j] = matrix[j, i] = 1e3 * run.number(f"coherency.pairs.{at}.mean")
    return matrix


def _matrix_of_contacts(run):
    """Share of time in which a user (row) feels each other, and the object (last column) [%]."""
    columns = [*(f"site{user}" for user in _users(run)), "object"]
    return 100 * np.array([[run.number(f"contacts.site{user}.{other}") for other in columns]
                           for user in _users(run)])


def _draw_matrix(axes, matrix, columns, rows, decimals):
    frame(axes)
    axes.grid(False)
    highest = np.nanmax(matrix, initial=0.0) or 1.0
    axes.imshow(matrix, cmap="YlGnBu", vmin=0, vmax=highest, aspect="auto")
    for (row, column), value in np.ndenumerate(matrix):
        if math.isfinite(value):
            axes.text(column, row, f"{value:.{decimals}f}", ha="center", va="center",
                      size=(12 if len(rows) <= 8 else 8) * PT,
                      color="white" if value > 0.6 * highest else "black")
    axes.set_xticks(range(len(columns)), columns)
    axes.set_yticks(range(len(rows)), rows)
    axes.tick_params(length=0)


def many_matrices(run, name):
    """Distances of copies by pair, and who feels whom."""
    numbers = [str(user) for user in _users(run)]
    size = 300

    def paint(sheet):
        left = LEFT
        if run.has_object:
            axes = sheet.panel(left, 90, 340, size, "mean distance of copies [mm]", "site", "site")
            _draw_matrix(axes, _matrix_of_pairs(run), numbers, numbers, 1)
            left += 340 + 90
        axes = sheet.panel(left, 90, LEFT + INNER - left, size, "time in which they feel [%]",
                           "user, or something else", "user who feels")
        _draw_matrix(axes, _matrix_of_contacts(run), [*numbers, "else"], numbers, 0)

    return Figure(
        name, f"Pairs of {run.sites} users ({label_of(run)})",
        "Left: how far apart the copies of each two sites are on average, at the same instant. "
        "Right: the share of the time in which a user’s device feels another user, or something "
        "else: the object." if run.has_object else
        "The share of the time in which a user’s device feels another user.", 90 + size + 60, paint)


def _style(run, is_dashed):
    """A scheme’s own colour and mark; the second mode is dashed."""
    return line(scheme_colour(run.scheme), 2, _DASH if is_dashed else None) | {
        "marker": scheme_marker(run.scheme), "markersize": 9 * PT, "markeredgewidth": 0}


def many_overview(group, name):
    """Coherency, drag and the largest force against the number of users."""
    drag_panel = ("drag of common motion", "[N s/m]", lambda run: run.number("drag.per_speed"))
    way_panel = ("way of user 1", "[mm]", lambda run: 1e3 * run.number("site1.device_end"))
    panels = [("copies, farthest pair", "mean distance [mm]",
               lambda run: 1e3 * run.number("coherency.mean_abs")),
              drag_panel if group.is_common_motion else way_panel,
              ("largest force on user 1", "[N]", lambda run: run.number("site1.force.max"))]

    def paint(sheet):
        styles, seen = {}, []
        for label, runs in group.series.items():
            styles[label] = _style(runs[0], is_dashed=runs[0].scheme in seen)
            seen.append(runs[0].scheme)
        theory = line("#000000", 1.2, (2, 3))
        sheet.legend([*styles.items()] +
                     [("couplers of copies alone", theory)] * group.is_common_motion)
        gap, counts = 66, sorted({run.sites for run in group.runs})
        width = (INNER - 2 * gap) / 3
        for p, (title, label, value) in enumerate(panels):
            axes = sheet.panel(LEFT + p * (width + gap), 104, width, 260, title, "users N", label,
                               54 if p else 56)
            highest = 1e-3
            for key, runs in group.series.items():
                values = [value(run) for run in runs]
                highest = max([highest, *(one for one in values if math.isfinite(one))])
                axes.plot([run.sites for run in runs], values, clip_on=False, **styles[key])
                if panels[p] is drag_panel:
                    drags = [coupler_drag(run) for run in runs]
                    highest = max([highest, *drags])
                    axes.plot([run.sites for run in runs], drags, **theory)
            axes.set_xlim(counts[0] - 0.5, counts[-1] + 0.5)
            axes.set_xticks(counts, [str(count) for count in counts])
            set_axis(axes, "y", (0, 1.1 * highest), 34)

    return Figure(
        name, "How the number of users changes the feel",
        "Mean distance of the two copies that are farthest apart, drag that each user feels, and "
        "largest force on user 1. Dotted: (N − 1) K_t τ of the couplers of copies alone, with τ "
        "the delay and half a packet period; averaging divides it by N." if group.is_common_motion
        else "Mean distance of the two copies that are farthest apart, how far user 1 has come at "
        "the end, and largest force on user 1.", 424, paint)
