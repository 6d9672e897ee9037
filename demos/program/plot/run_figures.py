"""Figures of runs over time: positions, forces and contact, one column of panels per scheme."""

import numpy as np

from canvas import INNER, LEFT, Figure, frame, line, set_axis, span
from findings import changes_of, changes_text, contact_verdict
from runs import CONTACT, separation
from words import USER_COLOURS, scheme_colour, scheme_label

_DASH = (7, 4)
_USER1, _USER2 = line(USER_COLOURS[1]), line(USER_COLOURS[2], dash=_DASH)
_TOP, _ROW_GAP, _COLUMN_GAP, _RIBBON, _BOTTOM = 94, 20, 18, 16, 58  # [px]


def recorded_time(t):
    """The time that a recording covers: to the end of its last tick [s]."""
    tick = t[1] - t[0] if len(t) > 1 else 1.0
    return t[0], t[-1] + tick


def contact_stretches(table):
    """Begin and length [s] of each stretch of time with contact."""
    t = table["t"]
    tick = t[1] - t[0] if len(t) > 1 else 0.0
    edges = np.diff(np.concatenate([[0], table["contact"] > 0.5, [0]]))
    return [(t[begin], t[end - 1] + tick - t[begin])
            for begin, end in zip(np.flatnonzero(edges > 0), np.flatnonzero(edges < 0))]


class Columns:
    """Panels in rows that share their axis of values and columns that share their axis of time.

    `rows` are pairs of a label and a height [px]. A column is a scheme and, for each row, a list of
    curves (t, y, looks); `contact` has the stretches for a ribbon below it.
    """

    def __init__(self, rows, legend):
        self.rows, self.legend, self.columns, self.contact = rows, legend, [], []

    def add(self, scheme, *curves, contact=None):
        self.columns.append((scheme, curves))
        if contact is not None:
            self.contact.append(contact)

    def height_for(self, has_ribbon):
        gaps = len(self.rows) * _ROW_GAP + (_RIBBON if has_ribbon else -_ROW_GAP)
        return _TOP + sum(height for _, height in self.rows) + gaps + _BOTTOM

    def paint(self, sheet):
        sheet.legend(self.legend)
        count = len(self.columns)
        width = (INNER - _COLUMN_GAP * (count - 1)) / count
        covered = [recorded_time(t) for _, rows in self.columns for t, _, _ in rows[0]]
        time = min(begin for begin, _ in covered), max(end for _, end in covered)
        top = _TOP
        for r, (label, height) in enumerate(self.rows):
            values = span(*(y for _, rows in self.columns for _, y, _ in rows[r]), least=1.0)
            is_lowest = r + 1 == len(self.rows) and not self.contact
            for c, (scheme, rows) in enumerate(self.columns):
                axes = sheet.panel(LEFT + c * (width + _COLUMN_GAP), top, width, height,
                                   "" if r else scheme_label(scheme),
                                   "time [s]" if is_lowest else "", "" if c else label)
                set_axis(axes, "x", time, 44, is_lowest)
                set_axis(axes, "y", values, 26, c == 0)
                for t, y, looks in rows[r]:
                    axes.plot(t[:len(y)], y, **looks)
            top += height + _ROW_GAP
        for c, stretches in enumerate(self.contact):
            axes = sheet.panel(LEFT + c * (width + _COLUMN_GAP), top, width, _RIBBON,
                               x_label="time [s]")
            set_axis(axes, "x", time, 44)
            axes.set_ylim(0, 1)
            axes.set_yticks([0.5], [""] if c else ["contact"])
            axes.tick_params(axis="y", length=0)
            axes.grid(False)
            frame(axes)
            axes.broken_barh(stretches, (0, 1), color=scheme_colour(self.columns[c][0]),
                             linewidth=0)


def cooperation_motion(group, name):
    """Positions of users and copies, and the force on user 1."""
    columns = Columns(
        [("along x [mm]", 170), ("from mean object [mm]", 190), ("force [N]", 130)],
        [("user 1", _USER1), ("user 2", _USER2), ("object, site 1", line("#000000", 2.4)),
         ("object, site 2", line("#000000", 2.4, _DASH))])

    def paint(sheet):
        for run in group.runs:
            tables = run.tables()
            rows = min(map(len, tables))
            t, colour = tables[0]["t"][:rows], scheme_colour(run.scheme)
            positions = [(1e3 * table[f"{who}_x"][:rows], looks)
                         for who, styles in (
                             ("device", (_USER1, _USER2)),
                             ("object", (line(colour, 2.4), line(colour, 2.4, _DASH))))
                         for table, looks in zip(tables, styles)]
            mean = (positions[2][0] + positions[3][0]) / 2
            columns.add(run.scheme, [(t, x, looks) for x, looks in positions],
                        [(t, x - mean, looks) for x, looks in positions],
                        [(tables[0]["t"], tables[0].norm("force"), line(colour, 1.4))])
        columns.paint(sheet)

    return Figure(
        name, "Positions of users and object copies, and force on user 1",
        "Top: displacement from the start along the axis from user 1 to user 2. Middle: the same, "
        "measured from the mean of the two copies (copies in the scheme’s colour). Bottom: size of "
        "the force on user 1.", columns.height_for(False), paint)


def contact_motion(group, name):
    """User-to-user contact as user 1 meets it, with a ribbon that is filled during contact."""
    user, proxy = line(USER_COLOURS[1], 2), line(USER_COLOURS[2], 2, _DASH)
    columns = Columns([("along x [mm]", 190), ("force [N]", 150)],
                      [("user 1", user), ("proxy of user 2", proxy),
                       ("force on user 1", line("#000000", 1.2))])

    def paint(sheet):
        for run in group.runs:
            table = run.tables()[0]
            t = table["t"]
            positions = [(t, 1e3 * table["device_x"], user)]
            if run.scheme != "virtual_coupling":
                positions.append((t, 1e3 * table["proxy_x"], proxy))
            columns.add(run.scheme, positions,
                        [(t, table.norm("force"), line(scheme_colour(run.scheme), 1.2))],
                        contact=contact_stretches(table))
        columns.paint(sheet)

    verdicts = "; ".join(f"{scheme_label(run.scheme)}: {contact_verdict(changes_of(run))} "
                         f"({changes_text(changes_of(run))})" for run in group.runs)
    return Figure(
        name, f"User 1 pushes user 2: contact {group.first.setting('contact.stiffness'):g} N/m, "
        f"network delay {group.first.setting('network.delay') * 1e3:g} ms",
        "Displacement from the start of user 1 and of user 2’s proxy at site 1, force on user 1, "
        f"and contact (filled) over time. Contact by scheme – {verdicts}.",
        columns.height_for(True), paint)


def live_motion(pairs, name):
    """Live runs beside the same in virtual time: what users share, and the force on user 1."""
    first = pairs[0][0]
    is_contact = first.kind == CONTACT
    live_looks = line("#000000", 1.4, (4, 3))
    columns = Columns([("user 1 along x [mm]" if is_contact else "|object 1 − object 2| [mm]", 190),
                       ("force, user 1 [N]", 150)],
                      [("virtual time (in the scheme’s colour)", line("#888888", 4)),
                       ("live, over real sockets", live_looks)])

    def paint(sheet):
        for live, virtual in pairs:
            shared, force = [], []
            for run, looks in ((virtual, line(scheme_colour(live.scheme), 4)), (live, live_looks)):
                if run:
                    tables = run.tables()
                    t = tables[0]["t"]
                    what = tables[0]["device_x"] if is_contact else separation(tables)
                    shared.append((t, 1e3 * what, looks))
                    force.append((t, tables[0].norm("force"), looks))
            columns.add(live.scheme, shared, force)
        columns.paint(sheet)

    return Figure(
        name, f"Live beside virtual time: {first.kind}, network delay "
        f"{first.setting('network.delay') * 1e3:g} ms",
        "Two programs with a network between them that delays real datagrams, and the same in "
        "virtual time. Intermittent contact is chaotic: there only its kind can agree.",
        columns.height_for(False), paint)


def spatial_motion(run, name):
    """Displacements along x, y and z, and forces: one run that moves in space."""
    legend = [("user 1", _USER1), ("user 2", _USER2)]
    if run.has_object:
        legend += [(f"object, site {site}", line(scheme_colour(run.scheme), dash=dash))
                   for site, dash in ((1, None), (2, _DASH))]

    def paint(sheet):
        sheet.legend(legend)
        tables = run.tables()
        t = tables[0]["t"]
        for p, axis in enumerate(["x", "y", "z", None]):
            title = f"along {axis}" if axis else "force on the users"
            label = "displacement [mm]" if axis else "force [N]"
            axes = sheet.panel(LEFT + p % 2 * 457, 98 + p // 2 * 290, 345, 190, title, "time [s]",
                               label)
            who = ("device", "object") if run.has_object else ("device",)
            signals = [1e3 * table[f"{one}_{axis}"] for one in who for table in tables] \
                if axis else [table.norm("force") for table in tables]
            for y, (_, looks) in zip(signals, legend):
                axes.plot(t[:len(y)], y[:len(t)], **looks)
            set_axis(axes, "x", recorded_time(t), 50)
            set_axis(axes, "y", span(*signals, least=1.0), 26)

    return Figure(
        name, "Motion of users and object copies, and forces",
        "Displacements from the start in the scene’s frame, solid at site 1 and dashed at site 2, "
        "and the size of the force on each user.", 640, paint)
