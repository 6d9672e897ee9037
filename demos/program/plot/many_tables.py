"""The table of runs with more than two sites."""

from html import escape

from many_runs import coupler_drag, mode_of
from page import scheme_cell, table
from words import fixed_text


def _mean_force(run):
    """Of all users [N]."""
    return sum(run.number(f"site{site}.force.mean") for site in range(1, run.sites + 1)) / run.sites


def many_table(group):
    def drag(run):
        return [fixed_text(run.number("drag.per_speed"), 2), fixed_text(coupler_drag(run), 2),
                fixed_text(1e3 * run.number("drag.speed"), 2)]

    def row(run):
        return [escape(run.name), str(run.sites), scheme_cell(run.scheme), escape(mode_of(run)) or "–",
                fixed_text(1e3 * run.number("coherency.mean_abs"), 2),
                fixed_text(1e3 * run.number("coherency.max_abs"), 2),
                *(drag(run) if group.is_common_motion else []),
                fixed_text(1e3 * run.number("site1.device_end"), 1), fixed_text(_mean_force(run), 3),
                fixed_text(run.number("site1.force.max"), 2)]

    return table(["run", "N", "scheme", "mode", "coherency, mean [mm]", "largest [mm]",
                  *(["drag [N s/m]", "couplers alone", "speed [mm/s]"] if group.is_common_motion
                    else []),
                  "way of user 1 [mm]", "mean force, all [N]", "largest, user 1 [N]"],
                 [row(run) for runs in group.series.values() for run in runs])
