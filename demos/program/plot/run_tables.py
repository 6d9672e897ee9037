"""Tables of the report: what was asked of runs and what they reached."""

import math
from html import escape

from findings import MEASURES, Order, changes_of, contact_verdict
from page import scheme_cell, table
from paper import paper_outcome
from runs import CONTACT, NAN
from words import fixed_text, scheme_label


def _number(run, key, factor=1):
    value = run.setting(key) * factor
    return f"{value:g}" if math.isfinite(value) else "–"


def _hand(run, site):
    """The hand's constant force along x, or how the hand moves when its force is another."""
    hand = run.settings.get(f"{site}.hand") or "constant"
    return _number(run, f"{site}.hand_force.0") if hand == "constant" else \
        escape(scheme_label(str(hand)))


def _pair(first, second):
    return lambda run: f"{_number(run, first)} / {_number(run, second)}"


_ASKED = [  # name, unit, text
    ("time", "s", lambda run: _number(run, "experiment.duration")),
    ("hands", "N", lambda run: f"{_hand(run, 'site1')} / {_hand(run, 'site2')}"),
    ("K_vc / B_vc", "N/m, N s/m", _pair("contact.stiffness", "contact.damping")),
    ("K_t / B_t", "N/m, N s/m", _pair("coordination.stiffness", "coordination.damping")),
    ("delay", "ms", lambda run: _number(run, "network.delay", 1e3)),
    ("b_dev", "N s/m", lambda run: _number(run, "device.damping"))]

# Header, key in the summary, factor, decimals.
_COHERENCY = [("mean [mm]", "coherency.mean_abs", 1e3, 2),
              ("largest [mm]", "coherency.max_abs", 1e3, 2),
              ("received, site 1 [mm]", "site1.coherency.received_mean", 1e3, 2),
              ("received, site 2 [mm]", "site2.coherency.received_mean", 1e3, 2)]
_MEAN_FORCE = ("mean force, user 1 [N]", "site1.force.mean", 1, 3)
_LARGEST_FORCE = ("largest force, user 1 [N]", "site1.force.max", 1, 2)
_CHANGES, _CHANGES_2 = ((f"contact changes, site {site}", f"site{site}.contact_transitions", 1, 0)
                        for site in (1, 2))
_END, _END_2 = ((f"user {user} at the end [m]", f"site{user}.device_end", 1, 4) for user in (1, 2))
_SPEED = ("times real time", "real_time_factor", 1, 0)
_REACHED_IN_CONTACT = [_CHANGES, _CHANGES_2, _LARGEST_FORCE, _MEAN_FORCE, _END, _END_2, _SPEED]
_REACHED = [*_COHERENCY, _MEAN_FORCE, _CHANGES, _END, _END_2, _SPEED]


def _reached(run, column):
    _, key, factor, decimals = column
    cell, paper = fixed_text(run.number(key) * factor, decimals), paper_outcome(run)
    if key in paper:
        cell += f'<span class="reference">{paper[key] * factor:g}</span>'
    return cell


def run_table(runs):
    """Runs of one kind. Settings that all share are said once, above the table."""
    texts = {name: [text(run) for run in runs] for name, _, text in _ASKED}
    shared = [f"{name} = {texts[name][0]} {unit}" for name, unit, _ in _ASKED
              if len(set(texts[name])) == 1]
    columns = [(name, unit) for name, unit, _ in _ASKED if len(set(texts[name])) > 1]
    reached = _REACHED_IN_CONTACT if runs[0].kind == CONTACT else _REACHED
    note = f"Asked{' of all' if len(runs) > 1 else ''}: {'; '.join(shared)}." if shared else ""
    return table(
        ["run", "scheme", *(f"{name} [{unit}]" for name, unit in columns),
         *(column[0] for column in reached)],
        [[escape(run.name), scheme_cell(run.scheme), *(texts[name][r] for name, _ in columns),
          *(_reached(run, column) for column in reached)] for r, run in enumerate(runs)],
        note, [("asked", 2 + len(columns)), ("reached", len(reached))])


def contact_table(groups):
    return table(
        ["case", "scheme", "contact changes", "contact is", "largest force [N]",
         "user 1 at the end [m]"],
        [[f"{run.setting('contact.stiffness'):g} N/m, {run.setting('network.delay') * 1e3:g} ms",
          scheme_cell(run.scheme), _reached(run, _CHANGES), contact_verdict(changes_of(run)),
          _reached(run, _LARGEST_FORCE), _reached(run, _END)]
         for group in groups for run in group.runs])


def sweep_table(sweep):
    header = ["b_dev [N s/m]"]
    rows = [[f"{point.damping:g}"] for point in sweep.points]
    if sweep.kind == CONTACT:
        for scheme in sweep.schemes:
            header += [f"{scheme_label(scheme)}: contact {what}" for what in ("changes", "is")]
            for row, point in zip(rows, sweep.points):
                changes = changes_of(point.find(scheme))
                row += [fixed_text(changes, 0), contact_verdict(changes)]
        return table(header, rows)
    for measure in MEASURES:
        header += [f"{measure} [mm], worst first", "the paper’s order?"]
        for row, point in zip(rows, sweep.points):
            order = Order(point, measure)
            answer = "✓ yes" if order.is_the_papers else "✗ no"
            row += ["<br>".join(scheme_cell(run.scheme) + value
                                for run, value in zip(order.worst_first, order.values)),
                    answer if order.is_complete else "–"]
    return table(header, rows)


def _difference(virtual, live):
    """By how many per cent live differs."""
    percent = 100 * (live / virtual - 1) if virtual else NAN
    return f"{percent:+.1f}" if math.isfinite(percent) else "–"


def live_table(pairs):
    """Pairs of a live run and its twin in virtual time, or None."""
    def compare(pair, column):
        _, key, factor, decimals = column
        live, virtual = pair[0].number(key), pair[1].number(key) if pair[1] else NAN
        return [" / ".join(fixed_text(one * factor, decimals) for one in (virtual, live)),
                _difference(virtual, live)]

    rows = []
    for pair in pairs:
        live = pair[0]
        is_shared = live.has_object and live.kind != CONTACT
        rows.append([live.kind, scheme_cell(live.scheme), _number(live, "network.delay", 1e3),
                     *(compare(pair, _COHERENCY[0]) if is_shared else ["–", "–"]),
                     *compare(pair, _MEAN_FORCE), compare(pair, _CHANGES)[0],
                     fixed_text(1e2 * live.number("loop.late_share"), 1),
                     fixed_text(1e3 * live.number("network.round_trip"), 1)])
    return table(["run", "scheme", "delay [ms]", "coherency, mean [mm]", "%", "force, user 1 [N]",
                  "%", "contact changes, site 1", "late ticks [%]", "round trip [ms]"], rows,
                 "Virtual time / live, and by how much live differs.")
