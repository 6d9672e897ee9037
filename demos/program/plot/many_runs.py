"""Runs of more than two sites: groups that differ in their number, the scheme and the mode alone."""

import json
from dataclasses import dataclass

from runs import COOPERATION
from words import scheme_label

_SCHEME, _MODE = "experiment.scheme", "coordination.mode"


def mode_of(run):
    """How copies are tied, where a run says it: "sum" or "average"."""
    return run.settings.get(_MODE, "")


def label_of(run):
    mode = mode_of(run)
    return scheme_label(run.scheme) + (f", {mode}" if mode else "") + (", live" if run.is_live else "")


def hands_of(run):
    """Constant forces of the first two hands along the axis, as a text."""
    return " / ".join(f"{run.setting(f'site.{site}.hand_force.0'):g}" for site in (0, 1))


def coupler_drag(run):
    """(N - 1) K_t tau of couplers alone, by mode; tau is the delay and half a packet period."""
    age = run.setting("network.delay") + 0.5 / run.setting("network.rate")
    others = run.sites - 1
    share = 1 / run.sites if mode_of(run) == "average" else 1
    return share * others * run.setting("coordination.stiffness") * age


@dataclass
class ManyGroup:
    """Runs that share all settings but N, scheme and mode, and the hands of users 1 and 2."""
    runs: list

    @property
    def has_object(self):
        return self.runs[0].has_object

    @property
    def is_common_motion(self):
        """True if all users push the object nearly all the time: then drag means something."""
        return self.has_object and all(
            run.number(f"contacts.site{site}.object") > 0.9
            for run in self.runs for site in range(1, run.sites + 1))

    @property
    def title(self):
        run = self.runs[0]
        what = "one object" if run.kind == COOPERATION else "each other" if not run.has_object else \
            "a scene"
        return f"Users move {what}: hands {hands_of(run)} N, delay " \
            f"{1e3 * run.setting('network.delay'):g} ms"

    @property
    def series(self):
        """Runs of each scheme and mode, by rising N."""
        lists = {}
        for run in sorted(self.runs, key=lambda run: run.sites):
            lists.setdefault(label_of(run), []).append(run)
        return lists

    @property
    def shown(self):
        """The run with most sites of each scheme and mode, at most four: they are shown in detail."""
        return [runs[-1] for runs in self.series.values()][:4]


def _common(run):
    settings = {key: value for key, value in run.settings_without(_SCHEME, _MODE).items()
                if not key.startswith("site")}
    return json.dumps([settings, hands_of(run)], sort_keys=True)


def group_many(runs):
    lists = {}
    for run in runs:
        lists.setdefault(_common(run), []).append(run)
    return [ManyGroup(members) for members in lists.values()]
