#!/usr/bin/env python3
"""Reads every #include and names the rule of the house that a line breaks.

    bench --> demos --> plugin --+--> bullet_bridge --+
                                 +--------------------+--> coordination      (arrow: may include)
                                 +--> falcon ---------+          tests --> everything

A library may include private headers of those it may use, by their path from the checkout; so may bench/,
which also uses the headers of demos/program/ in this way. Other programs and adaptors may not. demos/view/ draws what
demos/program/ makes, and is the only folder with graphics. An adaptor (plugin/doors/pybullet, plugin/doors/preload)
brings a site into a host that does not know of it: it may use more than plugin/, and only tests include it.

Usage: include_rule.py CHECKOUT     Ends with 1 when a line breaks a rule.
"""

import re
import sys
from dataclasses import dataclass
from pathlib import Path

LIBRARIES = ("coordination", "bullet_bridge", "falcon", "plugin")
FOLDERS = LIBRARIES + ("demos", "bench", "tests")
ADAPTORS = "plugin/doors/"   # a rule for all doors but the C door, which is part of plugin's library
C_DOOR = "plugin/doors/c/"
VIEW = "demos/view/"         # draws; beside it nothing knows graphics
VIEW_DOOR = VIEW + "window/window.h"   # for hosts
C_DOOR_WORDS = C_DOOR + "site_words.h"   # constants only: the names by which doors set the C door's fields
DDS_DOOR = {ADAPTORS + "dds/" + name for name in
            ("dds_carrier.h", "state_publisher.h", "site_states.h")}   # for programs
SUFFIXES = {".h", ".cpp", ".in"}

THREADS = {"thread", "mutex", "shared_mutex", "condition_variable", "future", "stop_token",
           "semaphore", "latch", "barrier", "pthread.h"}
LOCKS = {"mutex", "shared_mutex"}
CLOCKS = {"chrono", "ctime", "time.h", "sys/time.h", "sys/timerfd.h"}
FILES = {"fstream", "filesystem", "iostream", "syncstream", "fcntl.h", "unistd.h", "sys/stat.h"}
SOCKETS = {"netdb.h", "poll.h", "sys/epoll.h", "sys/un.h"}
SOCKET_FOLDERS = ("sys/socket", "netinet/", "arpa/", "net/")

# Prefixes of the headers of dependencies.
DEPENDENCIES = {
    "Bullet": re.compile(r"(bt[A-Z]|Bullet[A-Z]?\w*/|LinearMath/|bullet/)"),
    "Eigen": re.compile(r"(unsupported/)?Eigen/"),
    "fmt": re.compile(r"fmt/"),
    "nlohmann-json": re.compile(r"nlohmann/"),
    "toml++": re.compile(r"toml\+\+/"),
    "CLI11": re.compile(r"CLI/"),
    "Boost": re.compile(r"boost/"),
    "hidapi": re.compile(r"hidapi"),
    "libftdi1": re.compile(r"(ftdi\.h|libftdi1/)"),
    "MuJoCo": re.compile(r"mujoco/"),
    "ODE": re.compile(r"ode/"),
    "Simbody": re.compile(r"(Simbody\.h|SimTK)"),
    "libsodium": re.compile(r"sodium(\.h|/)"),
    "Cyclone DDS": re.compile(r"(dds/dds\.h|datagram\.h|states\.h)"),
    "GoogleTest": re.compile(r"(gtest|gmock)/"),
    "Google Benchmark": re.compile(r"benchmark/"),
    "rapidcheck": re.compile(r"rapidcheck"),
    "libFuzzer": re.compile(r"fuzzer/"),
    "GLFW": re.compile(r"GLFW/"),
    "Dear ImGui": re.compile(r"(imgui|backends/imgui)"),
    "OpenGL": re.compile(r"(GL|EGL|KHR)/"),
    "stb": re.compile(r"(stb/)?stb_"),
}


@dataclass(frozen=True)
class Rule:
    """What one folder may include besides its own headers."""

    libraries: tuple       # whose public headers
    dependencies: tuple    # None: any
    never: tuple = ()      # (what, headers of the standard library and the system)


RULES = {
    "coordination": Rule((), ("Eigen",), (
        ("thread", THREADS), ("clock", CLOCKS), ("file", FILES), ("socket", SOCKETS))),
    "bullet_bridge": Rule(("coordination",), ("Eigen", "Bullet"), (
        ("thread", THREADS - LOCKS), ("clock", CLOCKS), ("file", FILES), ("socket", SOCKETS))),
    "falcon": Rule(("coordination",), ("Eigen", "hidapi", "libftdi1")),
    "plugin": Rule(("coordination", "bullet_bridge", "falcon"), ("Eigen", "libsodium")),
    # An adaptor must look at a host's own bodies, and reads its settings from a file.
    ADAPTORS: Rule(LIBRARIES, ("Eigen", "Bullet", "toml++", "Cyclone DDS")),
    "demos": Rule(LIBRARIES, ("Eigen", "Bullet", "fmt", "nlohmann-json", "toml++", "CLI11",
                              "MuJoCo")),
    VIEW: Rule(LIBRARIES + ("demos",), ("Eigen", "Bullet", "fmt", "nlohmann-json", "GLFW", "Dear ImGui",
                                        "OpenGL", "stb")),
    "bench": Rule(LIBRARIES + ("demos",), ("Eigen", "Bullet", "fmt", "nlohmann-json", "Boost",
                                           "MuJoCo", "ODE", "Simbody")),
    "tests": Rule(LIBRARIES + ("demos", "bench"), None),
}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
PUBLIC = re.compile(r"tandem/(\w+)/")
FRONT_DOOR = re.compile(r"tandem/\w+\.h$")  # a library's own, beside its folder


@dataclass(frozen=True)
class Break:
    file: Path
    line: int
    header: str
    rule: str

    def __str__(self):
        return f"{self.file}:{self.line}: #include {self.header}: {self.rule}"


def folder_of(file):
    """The folder whose rule a file of the checkout goes by."""
    name = file.as_posix()
    if name.startswith(VIEW):
        return VIEW
    return ADAPTORS if name.startswith(ADAPTORS) and not name.startswith(C_DOOR) else file.parts[0]


def dependency_of(header):
    """The dependency that a header belongs to, or None: standard library, system, or ours."""
    for name, pattern in DEPENDENCIES.items():
        if pattern.match(header):
            return name
    return None


class House:
    """The folders of one checkout, and who owns which private header."""

    def __init__(self, checkout):
        self.checkout = Path(checkout)
        self.files = sorted(path for folder in FOLDERS for path in (self.checkout / folder).rglob("*")
                            if path.suffix in SUFFIXES and path.is_file())

    def breaks(self):
        return [found for path in self.files for found in self.breaks_of_file(path)]

    def breaks_of_file(self, path):
        file = path.relative_to(self.checkout)
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
            match = INCLUDE.match(line)
            if not match:
                continue
            rule = self.broken_rule(path, folder_of(file), match[1] == '"', match[2])
            if rule:
                yield Break(file, number, match[2], rule)

    def broken_rule(self, path, folder, quoted, header):
        """The rule that one include breaks, in words; None when it breaks none."""
        public = PUBLIC.match(header)
        if public:
            return self.broken_by_public(path, folder, public[1], header)
        if FRONT_DOOR.match(header):
            return self.broken_by_public(path, folder, self.owner_of_front_door(header), header)
        if quoted:
            return self.broken_by_private(path, folder, header)
        return broken_by_outside(folder, header)

    def owner_of_front_door(self, header):
        """The library with this header; plugin, whose headers hosts see, if there is none."""
        owners = [library for library in LIBRARIES
                  if (self.checkout / library / "include" / header).is_file()]
        return owners[0] if owners else "plugin"

    def broken_by_public(self, path, folder, owner, header):
        if owner not in LIBRARIES:
            return f"there is no library folder {owner}/"
        if not (self.checkout / owner / "include" / header).is_file():
            return f"{owner}/include has no such header"
        if owner != folder and owner not in RULES[folder].libraries:
            return f"{folder}/ may not include {owner}/"
        return None

    def broken_by_private(self, path, folder, header):
        if dependency_of(header):
            return broken_by_outside(folder, header)
        target = self.find_private(path, folder, header)
        if target is None:
            return "no such header in this folder; a dependency's header stands in <>"
        owner = folder_of(target.relative_to(self.checkout.resolve()))
        if is_public_header(path.relative_to(self.checkout)):
            return 'a public header includes public headers only, as "tandem/<folder>/<name>.h"'
        if owner == folder or folder == "tests":
            return None
        if owner == "tests":
            return f"{folder}/ may not include tests/"
        if folder == "demos" and target == (self.checkout / VIEW_DOOR).resolve():
            return None
        if folder == "demos" and target.relative_to(self.checkout.resolve()).as_posix() in DDS_DOOR:
            return None
        if owner in ("bench", ADAPTORS, VIEW):
            return f"nothing but tests/ includes {owner.rstrip('/')}/"
        if owner == "demos" and folder == VIEW:
            return None
        if owner == "demos":
            return self.broken_by_demos(folder, header)
        if folder == ADAPTORS and target == (self.checkout / C_DOOR_WORDS).resolve():
            return None
        if folder not in LIBRARIES + ("bench",):
            return f"{owner}'s private header: {folder.rstrip('/')}/ sees include/tandem/{owner} only"
        if owner not in RULES[folder].libraries:
            return f"{folder}/ may not include {owner}/"
        if not header.startswith(f"{owner}/src/"):
            return f'a private header of {owner}/ is included as "{owner}/src/..."'
        return None

    @staticmethod
    def broken_by_demos(folder, header):
        if folder != "bench":
            return "nothing but bench/ and tests/ includes demos/"
        if not header.startswith("demos/program/"):
            return 'a header of demos/ is included as "demos/program/..."'
        return None

    def find_private(self, path, folder, header):
        """The file behind a quoted include: beside the includer, in the folder's sources, then anywhere."""
        places = [path.parent, self.checkout, self.checkout / folder / "src", self.checkout / folder,
                  self.checkout / folder / "program"]
        places += [self.checkout / other / "src" for other in FOLDERS]
        places += [self.checkout / "demos" / "program", self.checkout / VIEW, self.checkout / ADAPTORS]
        for place in places:
            target = (place / header).resolve()
            if target.is_file() and self.checkout.resolve() in target.parents:
                return target
        return None


def is_public_header(file):
    return len(file.parts) > 1 and file.parts[1] == "include"


def broken_by_outside(folder, header):
    """Rules on the standard library, the system and the dependencies."""
    rule = RULES[folder]
    dependency = dependency_of(header)
    if dependency:
        if rule.dependencies is None or dependency in rule.dependencies:
            return None
        if dependency == "Bullet" and folder in LIBRARIES:
            return "bullet_bridge/ is the only library folder with Bullet's headers"
        return f"{folder}/ may not use {dependency}; it may use {', '.join(rule.dependencies)}"
    for what, headers in rule.never:
        if header in headers or (what == "socket" and header.startswith(SOCKET_FOLDERS)):
            return f"{folder}/ has no {what}"
    return None


def main(arguments):
    if len(arguments) != 1 or not Path(arguments[0]).is_dir():
        print(__doc__, file=sys.stderr)
        return 2
    house = House(arguments[0])
    if not house.files:
        print(f"{arguments[0]}: no sources here; give the folder of the checkout", file=sys.stderr)
        return 2
    breaks = house.breaks()
    for found in breaks:
        print(found)
    print(f"{len(house.files)} files, {len(breaks)} broken include rules")
    return 1 if breaks else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
