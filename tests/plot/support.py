"""What the tests of the figures share: the package on the path, run folders, and messages."""

import copy
import json
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "demos/program/plot"))

from runs import make_run  # noqa: E402
from table import UsageError  # noqa: E402

COOPERATION, CONTACT = "cooperative_manipulation", "user_contact"
VC, KP, RDP = "virtual_coupling", "kinematic_proxy", "remote_dynamic_proxy"

_SUMMARY = {
    "scenario": {
        "experiment": {"duration": 1, "axis": [1, 0, 0], "guide": True},
        "contact": {"stiffness": 4000, "damping": 1},
        "coordination": {"stiffness": 200, "damping": 30},
        "object": {"mass": 0.2, "damping": 0, "size": 0.04},
        "proxy": {"mass": 0.1, "damping": 0, "radius": 0.01},
        "device": {"mass": 0.1, "damping": 0.5},
        "site1": {"hand_force": [5, 0, 0]}, "site2": {"hand_force": [0, 0, 0]},
        "network": {"delay": 0.05, "rate": 128, "loss": 0},
        "rates": {"haptic": 1000, "host": 240}},
    "coherency": {"mean_abs": 0.006, "max_abs": 0.01},
    "site1": {"coherency": {"received_mean": 0.012}, "contact_transitions": 1,
              "force": {"max": 7.5, "mean": 4.9}, "device_end": 0.13},
    "site2": {"coherency": {"received_mean": 0.001}, "contact_transitions": 3,
              "force": {"max": 4, "mean": 1}, "device_end": 0.12},
    "state_hash": "00ff", "real_time_factor": 300.0, "scalar": "float64"}


def summary(scheme=KP, kind=COOPERATION, **changes):
    """A summary with the settings of the paper's Experiment I, or II for user_contact.

    `changes` are dotted keys with __ for the dot, such as scenario__network__delay=0.1.
    """
    s = copy.deepcopy(_SUMMARY)
    s["scenario"]["experiment"] |= {"kind": kind, "scheme": scheme}
    if kind == CONTACT:
        s["scenario"]["experiment"]["duration"] = 2
        s["scenario"]["contact"]["stiffness"] = 2000
        s["scenario"]["coordination"]["damping"] = 10
        s["scenario"]["site1"]["hand_force"][0] = 3
        s["scenario"]["network"]["delay"] = 0.1
    for key, value in changes.items():
        *path, last = key.split("__")
        place = s
        for part in path:
            place = place[part]
        if value is None:
            del place[last]
        else:
            place[last] = value
    return s


def run_of(scheme=KP, kind=COOPERATION, name="run", **changes):
    return make_run(summary(scheme, kind, **changes), name, f"{name}/summary.json")


def site_csv(shift=0.0, rows=40):
    """A site's table: everything moves along x, contact comes and goes."""
    columns = ["t", "contact", *(f"{what}_{axis}" for what in ("device", "object", "proxy", "force")
                                 for axis in "xyz")]
    lines = [",".join(columns)]
    for k in range(rows):
        x = 1e-3 * k + shift
        lines.append(f"{k / 1000},{k // 10 % 2}" + f",{x},0,0" * 3 + f",{k % 7},0,1")
    return "\n".join(lines) + "\n"


class FolderTest(unittest.TestCase):
    """A test with a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, content):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        return str(path)

    def make_run_folder(self, name, *arguments, **changes):
        self.write(f"{name}/summary.json", summary(*arguments, **changes))
        self.write(f"{name}/site1.csv", site_csv())
        self.write(f"{name}/site2.csv", site_csv(0.002))
        return str(self.folder / name)


def message_of(action):
    """The message of the UsageError that `action` raises; empty when it raises none."""
    try:
        action()
    except UsageError as error:
        return str(error)
    return ""
