"""Run folders: what was asked for and what came out, in virtual time or live."""

import json
import math
import os
from dataclasses import dataclass

import numpy as np

from table import UsageError, read_table, read_text
from words import SCHEMES, join_words

NAN = math.nan
COOPERATION, CONTACT, PLAYGROUND = "cooperation", "user-to-user contact", "playground"
_KINDS = {"cooperative_manipulation": COOPERATION, "user_contact": CONTACT}

# Keys in which two sites of one live run may differ; demos/program/scenario/keys.cpp marks them, too.
_OWN_KEYS = ("title", "site1.", "site2.", "site.", "device.", "guard.", "network.delay", "network.jitter",
             "network.loss", "network.duplicate", "network.reorder", "network.seed", "rates.host",
             "rates.inner", "experiment.duration", "bridge.")


_MEASURED = ["coherency.mean_abs", "coherency.max_abs", "real_time_factor",
             *(f"site{site}.{key}" for site in (1, 2) for key in (
                 "coherency.received_mean", "contact_transitions", "force.max", "force.mean",
                 "device_end"))]


@dataclass
class Body:
    """A body of a run's scene, as one site sees it. Sizes in metres."""
    site: int  # from 1
    name: str
    role: str  # object, proxy, device, neighbour or obstacle
    is_static: bool
    half_extents: np.ndarray = None  # of a box
    radius: float = 0.0  # of a sphere

    @property
    def is_box(self):
        return self.half_extents is not None

    @property
    def is_user(self):
        return self.role in ("device", "proxy")

    @property
    def user(self):
        """The number of the user whose device or proxy this is. Proxies of a site are numbered in
        the order of the other users: proxy, proxy2, proxy3."""
        if self.role == "device":
            return self.site
        place = int(self.name.removeprefix("proxy") or 1)
        return place if place < self.site else place + 1


@dataclass
class Run:
    """What was asked for and what came out. `values` has all of the summary by dotted key."""
    folder: str
    name: str
    title: str
    kind: str
    scheme: str
    values: dict
    settings: dict  # values of the scenario, without titles
    bodies: list
    is_live: bool = False

    @property
    def sites(self):
        """The number of sites; two at least, of which a live run may lack one."""
        return max([2, *(int(key.split(".")[0][4:]) for key in self.values
                         if key.startswith("site") and key.endswith(".contact_transitions"))])

    @property
    def has_object(self):
        return not self.bodies or any(body.role == "object" for body in self.bodies)

    def number(self, key):
        """A number of the summary; NaN when it is not there."""
        value = self.values.get(key)
        return value if isinstance(value, float) else NAN

    def setting(self, key):
        """A number of the scenario; NaN when it is not there."""
        return self.number(f"scenario.{key}")

    def tables(self):
        """site1.csv, site2.csv and those of further sites."""
        return [read_table(os.path.join(self.folder, f"site{site}.csv"))
                for site in range(1, self.sites + 1)]

    def settings_without(self, *keys):
        return {key: value for key, value in self.settings.items() if key not in keys}


def flatten(value, key=""):
    """Leaves of nested JSON by dotted key; numbers as float, so that 200 equals 200.0."""
    if isinstance(value, (dict, list)):
        items = value.items() if isinstance(value, dict) else enumerate(value)
        return {k: v for name, inner in items
                for k, v in flatten(inner, f"{key}.{name}" if key else str(name)).items()}
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return {key: float(value) if is_number else value}


class Summary:
    """A JSON object read by dotted key, with messages that name file and key."""

    def __init__(self, root, source):
        self.root, self.source = root, source

    def get(self, key, kind, name, default=None):
        value = self.root
        for part in key.split("."):
            if isinstance(value, list) and part.isdigit():
                value = dict(enumerate(value)).get(int(part))
            else:
                value = value.get(part) if isinstance(value, dict) else None
        if value is None:
            if default is not None:
                return default
            self.refuse(key, "is missing")
        if not isinstance(value, kind) or isinstance(value, bool):
            self.refuse(key, f"must be a {name}")
        return value

    def number(self, key, default=None):
        return float(self.get(key, (int, float), "number", default))

    def text(self, key, default=None):
        return self.get(key, str, "text", default)

    def refuse(self, key, problem):
        raise UsageError(f'{self.source}: key "{key}" {problem}')


def parse_object(text, source):
    def refuse(name):
        raise ValueError(name)
    try:
        value = json.loads(text.removeprefix("\ufeff"), parse_constant=refuse)
    except (ValueError, RecursionError):
        value = None
    if not isinstance(value, dict):
        raise UsageError(f"{source}: not a JSON object")
    return value


def _read_body(summary, at):
    role, shape = summary.text(f"{at}.role"), summary.text(f"{at}.shape")
    body = Body(round(summary.number(f"{at}.site")), summary.text(f"{at}.name", role),
                role, summary.text(f"{at}.motion", "dynamic") == "static")
    if shape == "box":
        body.half_extents = np.array([summary.number(f"{at}.half_extents.{i}") for i in range(3)])
    elif shape == "sphere":
        body.radius = summary.number(f"{at}.radius")
    else:
        summary.refuse(f"{at}.shape", f'is "{shape}"; allowed are box and sphere')
    return body


def _read_bodies(summary):
    count = len(summary.get("scene.bodies", list, "list", []))
    return [_read_body(summary, f"scene.bodies.{index}") for index in range(count)]


def make_run(root, folder, source):
    """A run from its summary, already read; `source` names it in messages."""
    summary = Summary(root, source)
    kind = _KINDS.get(summary.text("scenario.experiment.kind"), PLAYGROUND)
    scheme = summary.text("scenario.experiment.scheme")
    if scheme not in SCHEMES:
        summary.refuse("scenario.experiment.scheme",
                       f'is "{scheme}"; allowed are {join_words(SCHEMES)}')
    for key in _MEASURED:
        is_needed = key.endswith("transitions") or kind == COOPERATION and key.endswith("mean_abs")
        summary.number(key, None if is_needed else NAN)
    name = os.path.basename(os.path.abspath(folder))
    settings = {key: value for key, value in flatten(root["scenario"]).items()
                if key.split(".")[-1] not in ("name", "title", "description")}
    return Run(folder, name, summary.text("title", summary.text("scenario.name", "")) or name, kind,
               scheme, flatten(root), settings | {"scalar": summary.text("scalar", "")},
               _read_bodies(summary))


def load_run(folder):
    """Reads summary.json of `folder`, or what two `tandem peer` have left there."""
    if is_live_folder(folder):
        return load_live_run(folder)
    path = os.path.join(folder, "summary.json")
    return make_run(parse_object(read_text(path), path), folder, path)


def _pairs(count):
    return [(i, j) for i in range(count) for j in range(i + 1, count)]


def pair_separations(tables):
    """|object at one site - object at another| of each pair, tick by tick [m]; sites may differ by a
    few rows."""
    copies = [table.vectors("object") for table in tables]
    rows = min(len(copy) for copy in copies)
    return np.array([np.linalg.norm(copies[i][:rows] - copies[j][:rows], axis=1)
                     for i, j in _pairs(len(copies))])


def separation(tables):
    """Distance of the two copies that are farthest apart, tick by tick [m]."""
    return pair_separations(tables).max(axis=0)


def is_live_folder(folder):
    """True if some `tandem peer` have written to this folder, and no `tandem run`."""
    return os.path.exists(os.path.join(folder, "site1.json")) and \
        not os.path.exists(os.path.join(folder, "summary.json"))


def _shared_settings(site):
    return {key: value for key, value in flatten(site.get("scenario", {})).items()
            if not key.startswith(_OWN_KEYS)}


def _count_sites(root):
    scenario = root.get("scenario")
    sites = scenario.get("site") if isinstance(scenario, dict) else None
    return max(2, len(sites)) if isinstance(sites, list) else 2


def _describe_coherency(tables):
    """With more than two sites, that of each pair, too, as in summary.json."""
    apart = pair_separations(tables)
    farthest = apart.max(axis=0)
    coherency = {"mean_abs": farthest.mean(), "max_abs": farthest.max()}
    if len(tables) > 2:
        coherency["pairs"] = [{"i": i + 1, "j": j + 1, "mean": one.mean(), "max": one.max()}
                              for (i, j), one in zip(_pairs(len(tables)), apart, strict=True)]
    return coherency


def load_live_run(folder):
    """Joins site1.json and those of all other sites, and computes from all tables what only all
    tell."""
    path = os.path.join(folder, "site1.json")
    whole = parse_object(read_text(path), path)
    roots, names = [whole], [f"site{site + 1}" for site in range(_count_sites(whole))]
    for name in names[1:]:
        other_path = os.path.join(folder, f"{name}.json")
        other = parse_object(read_text(other_path), other_path)
        if _shared_settings(whole) != _shared_settings(other) or _count_sites(other) != len(names):
            raise UsageError(f"{other_path}: another scenario than in {path}; give a folder that "
                             "all sites of one run wrote to")
        roots.append(other)
    sites = [Summary(root, name) for root, name in zip(roots, names, strict=True)]
    ticks, late = (sum(site.number(f"loop.{key}", NAN) for site in sites)
                   for key in ("ticks", "late"))
    for root, name in zip(roots[1:], names[1:], strict=True):
        whole[name] = root.get(name, {})
        whole.setdefault("contacts", {}).update(root.get("contacts", {}))
    whole["loop"] = {"late_share": late / ticks if ticks else NAN}
    whole["coherency"] = _describe_coherency(
        [read_table(os.path.join(folder, f"{name}.csv")) for name in names])
    run = make_run(whole, folder, folder)
    run.is_live = True
    return run
