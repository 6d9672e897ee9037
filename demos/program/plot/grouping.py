"""How a report presents many runs: groups that differ in the scheme alone, and sweeps."""

import json
from dataclasses import dataclass

from paper import paper_outcome
from runs import CONTACT, COOPERATION, PLAYGROUND
from words import SCHEMES, setting_text

_SCHEME, _DAMPING = "experiment.scheme", "device.damping"
_KINDS = [COOPERATION, CONTACT, PLAYGROUND]


@dataclass
class Group:
    """Runs that share every setting but the scheme: one run per scheme, in the schemes' order."""
    runs: list
    difference: str = ""  # settings that set it apart from its siblings

    @property
    def first(self):
        return self.runs[0]

    @property
    def damping(self):
        return self.first.setting(_DAMPING)

    def find(self, scheme):
        return next((run for run in self.runs if run.scheme == scheme), None)


@dataclass
class Sweep:
    """Groups that share every setting but `device.damping`, by rising damping; at least two."""
    points: list
    difference: str = ""  # settings that set it apart from other sweeps of its kind

    @property
    def kind(self):
        return self.points[0].first.kind

    @property
    def schemes(self):
        return [scheme for scheme in SCHEMES if any(point.find(scheme) for point in self.points)]


def text_without_scheme(run, *more):
    """All settings but the scheme as one text, equal for runs that differ in nothing else."""
    return json.dumps(run.settings_without(_SCHEME, *more), sort_keys=True)


def _group_by(items, key):
    """Lists of items with equal keys, in the order of their first items."""
    lists = {}
    for item in items:
        lists.setdefault(key(item), []).append(item)
    return list(lists.values())


def _make_group(runs):
    """Of runs with equal settings the first given stands for all."""
    by_scheme = {}
    for run in runs:
        by_scheme.setdefault(run.scheme, run)
    return Group(sorted(by_scheme.values(), key=lambda run: SCHEMES.index(run.scheme)))


def _find_sweeps(groups):
    families = _group_by(groups, lambda group: text_without_scheme(group.first, _DAMPING))
    sweeps = [Sweep(sorted(family, key=lambda group: group.damping))
              for family in families if len(family) > 1]
    return sorted(sweeps, key=lambda sweep: _KINDS.index(sweep.kind))


def _detail_of(sweep, runs):
    """The one point that is shown in detail: the paper's, else the one given first."""
    for point in sweep.points:
        if paper_outcome(point.first):
            return point
    order = [id(run) for run in runs]
    return min(sweep.points, key=lambda point: min(order.index(id(run)) for run in point.runs))


def _name_differences(members, settings_of):
    """Writes with units what tells siblings apart: "contact stiffness 4000 N/m"."""
    settings = [settings_of(member) for member in members]
    keys = sorted({key for one in settings for key in one})
    differing = [key for key in keys if len({repr(one.get(key)) for one in settings}) > 1]
    for member, one in zip(members, settings):
        member.difference = ", ".join(setting_text(key, one.get(key)) for key in differing)


class Grouping:
    """Sorts runs in virtual time by their settings alone.

    `groups` has a list for each kind of run. Of the points of a sweep only one is among them.
    """

    def __init__(self, runs):
        virtual = [run for run in runs if not run.is_live]
        groups = [_make_group(members) for members in _group_by(virtual, text_without_scheme)]
        self.sweeps = _find_sweeps(groups)
        hidden = {id(point) for sweep in self.sweeps for point in sweep.points
                  if point is not _detail_of(sweep, runs)}
        self.groups = {kind: [group for group in groups
                              if group.first.kind == kind and id(group) not in hidden]
                       for kind in _KINDS}
        for kind in _KINDS:
            _name_differences(self.groups[kind],
                              lambda group: group.first.settings_without(_SCHEME))
            _name_differences([sweep for sweep in self.sweeps if sweep.kind == kind],
                              lambda sweep: sweep.points[0].first.settings_without(
                                  _SCHEME, _DAMPING))
