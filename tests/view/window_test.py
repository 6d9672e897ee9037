#!/usr/bin/env python3
"""Drives `tandem view` on a display of its own as a user does: pushes, switches the scheme, ends. Shows a recorded
run, and makes films of it. Then what goes wrong: no display, a bad world, a bad option.

Usage: window_test.py TANDEM WITH_WINDOW
"""

import json
import os
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PATIENCE = 30.0  # [s]


class Display:
    """A screen without a monitor."""

    def __init__(self):
        read, write = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x800x24", "-nolisten", "tcp"],
            pass_fds=(write,), stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as pipe:
            self.name = ":" + pipe.readline().strip()
        self.environment = dict(os.environ, DISPLAY=self.name)

    def do(self, *words):
        subprocess.run(["xdotool", *map(str, words)], env=self.environment, check=True)

    def press(self, key):
        # The window looks at the keys once a frame, which may take long on a busy machine.
        self.do("keydown", key, "sleep", 1.0, "keyup", key)

    def end(self):
        self.server.terminate()
        self.server.wait()


class View:
    """A window that writes down what it shows."""

    def __init__(self, tandem, display, folder, *options):
        self.status = folder / "status.jsonl"
        self.status.unlink(missing_ok=True)
        self.process = subprocess.Popen([tandem, "view", "--status", self.status, *options],
                                        env=display.environment)

    def notes(self):
        if not self.status.exists():
            return []
        lines = self.status.read_text().split("\n")[:-1]
        return [json.loads(line) for line in lines]

    def wait_for(self, what, holds):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            notes = self.notes()
            if notes and holds(notes[-1]):
                return notes[-1]
            if self.process.poll() is not None:
                sys.exit(f"the window ended with {self.process.returncode} before {what}")
            time.sleep(0.05)
        sys.exit(f"waited in vain for {what}; last: {self.notes()[-1:]}")

    def end(self):
        return self.process.wait(timeout=PATIENCE)


def check(is_good, what):
    if not is_good:
        sys.exit(f"failed: {what}")


def push_and_switch(tandem, display, folder):
    view = View(tandem, display, folder, "cube", "--set", "site2.hand_waypoints=[[0,0,0,0]]",
                "--set", "object.mass=0.6", "--size", "1280x800", "--screenshot", folder / "last.png")
    first = view.wait_for("the first picture", lambda note: note["frames"] > 5)
    check(first["scheme"] == "remote_dynamic_proxy", "the world's scheme at first")
    # From the user's hand to the right, where the cube is.
    display.do("mousemove", 560, 400)
    end = time.monotonic() + PATIENCE
    while max(note["force"] for note in view.notes()) <= 0.5:
        check(time.monotonic() < end, "the push is felt")
        shown = view.notes()[-1]["frames"]
        display.do("mousemove_relative", 4, 2, "sleep", 0.05)
        # On a busy machine a picture takes long, and the window sees the pointer once a picture.
        view.wait_for("a later picture", lambda note, since=shown: note["frames"] > since)
    moved = view.wait_for("a cube that moves", lambda note: note["object"][0] - first["object"][0] > 0.01)
    check(moved["status"] == 0, "no fault while pushing")
    display.press("1")
    view.wait_for("another scheme", lambda note: note["scheme"] != "remote_dynamic_proxy" and note["time"] > 0.2)
    pause_and_step(view, display)
    switch_contact(view, display)
    display.press("Next")
    view.wait_for("another world", lambda note: note["world"] == "door" and note["time"] > 0.2 and note["status"] == 0)
    display.press("Escape")
    check(view.end() == 0, "Escape ends the window with status 0")
    check((folder / "last.png").read_bytes()[:4] == b"\x89PNG", "a screenshot")


def pause_and_step(view, display):
    display.press("space")
    first = view.wait_for("a pause", lambda note: note["paused"])
    paused = view.wait_for("a paused world", lambda note: note["frames"] > first["frames"] + 5)
    later = view.wait_for("later pictures", lambda note: note["frames"] > paused["frames"] + 10)
    check(all(later[name] == paused[name] for name in ("time", "hip", "object", "force")), "the world stands still")
    display.press("period")
    stepped = view.wait_for("a step", lambda note: note["time"] > paused["time"])
    steps = (stepped["time"] - paused["time"]) * 60.0  # the world's host rate; a key that is held repeats
    check(abs(steps - round(steps)) < 0.1 and stepped["paused"], f"whole host periods, not {steps}")
    display.press("space")
    view.wait_for("the world to go on", lambda note: not note["paused"] and note["time"] > stepped["time"] + 0.5)


def switch_contact(view, display):
    """Bullet's own contact and back. The joints of point_to_point let the cube fly apart, and Tandem begins anew."""
    for key, contact, keeps_places in (("F4", "native_soft", True), ("F2", "island", True),
                                       ("F6", "point_to_point", False), ("F2", "island", False)):
        before = view.notes()[-1]
        display.press(key)
        after = view.wait_for(contact, lambda note, wanted=contact: note["contact"] == wanted)
        if keeps_places:
            way = max(abs(a - b) for a, b in zip(after["object"], before["object"], strict=True))
            check(way < 0.05, f"the cube stays where it was, not {way} m away")
        view.wait_for("a world that goes on", lambda note, since=after: note["frames"] > since["frames"] + 5)
    last = view.wait_for("a world that is whole", lambda note: note["time"] > 0.5)
    check(last["status"] == 0 and max(map(abs, last["object"])) < 1.0, "the cube is back")


def meet_a_friend(tandem, worlds, display, folder):
    """User 1 in a window, user 2 without one, who leaves first."""
    key = folder / "key"
    subprocess.run([tandem, "key", "new", key], check=True, stdout=subprocess.DEVNULL)
    ports = free_ports()
    settings = ["--set", "experiment.duration=6"]
    view = View(tandem, display, folder, "cube", *settings, "--site", "1", "--key", key, "--record", folder / "met",
                "--bind", f"127.0.0.1:{ports[0]}", "--peer", f"127.0.0.1:{ports[1]}")
    view.wait_for("a picture while waiting", lambda note: note["waiting"] and note["frames"] > 5)
    friend = subprocess.Popen([tandem, "peer", "--scenario", worlds / "cube.toml", *settings, "--site", "2", "--key", key,
                               "--bind", f"127.0.0.1:{ports[1]}", "--peer", f"127.0.0.1:{ports[0]}", "--quiet"])
    first = view.wait_for("the friend", lambda note: not note["waiting"])
    check(first["link"] == "live", "the friend is felt")
    # Another scheme: the friend follows, and begins its duration anew.
    display.press("1")
    first = view.wait_for("a friend who follows", lambda note: note["scheme"] != first["scheme"] and not note["waiting"] and
                          note["link"] == "live" and 100 < note["ticks"])
    check(friend.wait(timeout=PATIENCE) == 0, "the friend ends with status 0")
    last = view.wait_for("that the friend has left", lambda note: note["link"] != "live")
    check(last["ticks"] > first["ticks"] + 1000, "they met for more than a second")
    check(not (folder / "met-2" / "site1.json").exists(), "a record is stored at its end")
    display.press("Escape")
    check(view.end() == 0, "Escape ends the window with status 0")
    for name in ("met", "met-2"):
        check(sorted(path.name for path in (folder / name).iterdir()) == ["scene1.csv", "site1.csv", "site1.json"],
              "a record of the own site, and nothing else")
    refuse(tandem, display.environment, 2, "give --site 1", "--replay", folder / "met", "--site", "2")


def watch_a_room(tandem, worlds, display, folder):
    """A class in a window follows two users, of whom the first leaves, and never says anything to them."""
    for key in ("relay", "pair", "watch", "other"):
        subprocess.run([tandem, "key", "new", folder / key], check=True, stdout=subprocess.DEVNULL)
    port = free_ports()[0]
    relay = subprocess.Popen([tandem, "relay", "--bind", f"127.0.0.1:{port}", "--key", folder / "relay", "--quiet"])
    room = ["--relay", f"127.0.0.1:{port}", "--relay-key", folder / "relay"]
    users = [subprocess.Popen([tandem, "peer", "--scenario", worlds / "crate.toml", "--set", "experiment.duration=60",
                               "--site", site, "--bind", "127.0.0.1:0", "--key", folder / "pair", *room,
                               "--watch-key", folder / "watch", "--quiet"]) for site in ("1", "2")]
    watch = ["--watch", *room, "--watch-key"]
    view = View(tandem, display, folder, "crate", *watch, folder / "watch", "--screenshot", folder / "room.png")
    first = view.wait_for("both users", lambda note: [user["live"] for user in note.get("users", [])] == [True] * 2)
    check(first["followed"] == 1, "user 1 is followed at first")
    view.wait_for("a hand that moves", lambda note: note["hip"][0] - first["hip"][0] > 0.01)
    display.press("2")
    view.wait_for("user 2's copies", lambda note: note["followed"] == 2)
    users[0].terminate()
    view.wait_for("a silent user", lambda note: not note["users"][0]["live"] and note["users"][1]["live"])
    refuse(tandem, display.environment, 1, "--watch-key opens no state", "crate", *watch, folder / "other")
    refuse(tandem, display.environment, 2, "has another scenario", "cube", *watch, folder / "watch")
    refuse(tandem, display.environment, 2, "leave out --peer", "crate", *watch, folder / "watch", "--device", "emulated")
    refuse(tandem, display.environment, 2, "a spectator has no --site", "crate", *watch, folder / "watch", "--site", "1")
    refuse(tandem, display.environment, 2, "--watch needs --relay", "crate", "--watch", "--watch-key", folder / "watch")
    display.press("Escape")
    check(view.end() == 0, "Escape ends watching with status 0")
    check((folder / "room.png").read_bytes()[:4] == b"\x89PNG", "a screenshot of a room")
    for process in (*users, relay):
        process.terminate()
        check(process.wait(timeout=PATIENCE) == 0, "users and relay end with status 0")


def record_until_a_signal(tandem, display, folder):
    """SIGTERM in the middle of a push leaves a whole record, and SIGKILL none."""
    for name, is_kind in (("killed", False), ("ended", True)):
        view = View(tandem, display, folder, "cube", "--record", folder / name)
        display.do("mousemove", 560, 400, "mousemove_relative", 300, 0)
        view.wait_for("a session to record", lambda note: note["time"] > 1.0)
        (view.process.terminate if is_kind else view.process.kill)()
        status = view.end()
        check((status == 0) == is_kind, f"{name}: status {status}")
    check(not list((folder / "killed").glob("*.json")), "nothing is published by a killed window")
    view = View(tandem, display, folder, "--replay", folder / "ended", "--seconds", "2")
    view.wait_for("the session again", lambda note: note["time"] > 0.2)
    check(view.end() == 0, "a replay of a session ends with status 0")


def replay_a_run(tandem, worlds, display, folder):
    run = folder / "run"
    subprocess.run([tandem, "run", worlds / "cube.toml", "--out", run, "--quiet"], check=True)
    view = View(tandem, display, folder, "--replay", run, "--site", "2", "--screenshot", folder / "replay.png")
    view.wait_for("a run that plays", lambda note: note["frames"] > 5 and note["time"] > 0.2)
    display.press("space")
    stopped = view.wait_for("a run that pauses", lambda note: len(view.notes()) > 1
                            and note["time"] == view.notes()[-2]["time"])
    display.press("Right")
    later = view.wait_for("a later picture", lambda note: note["time"] > stopped["time"])
    display.press("Home")
    view.wait_for("the beginning", lambda note: note["time"] == 0.0)
    check(later["time"] < 6.0, "the pause came before the end")
    display.press("Escape")
    check(view.end() == 0, "Escape ends the window with status 0")
    check((folder / "replay.png").read_bytes()[:4] == b"\x89PNG", "a screenshot of a run")
    refuse(tandem, display.environment, 2, "--replay: shows what was recorded", "cube", "--replay", run)
    refuse(tandem, display.environment, 2, "has sites 1 to 2", "--replay", run, "--site", "3")
    (run / "scene.csv").unlink()
    refuse(tandem, display.environment, 2, "scene.csv: cannot be read", "--replay", run)


def free_ports():
    sockets = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def film_a_run(tandem, display, folder):
    for rate, pictures in ((30, 31), (10, 11)):
        out = folder / f"film{rate}"
        subprocess.run([tandem, "film", folder / "short", "--out", out, "--rate", str(rate), "--size", "64x64",
                        "--quiet"], check=True)
        check(len(list(out.iterdir())) == pictures, f"{pictures} pictures of a second at {rate} Hz")
    out = folder / "bad"
    refuse(tandem, display.environment, 2, "--rate 31", folder / "short", "--out", out, "--rate", "31", command="film")
    refuse(tandem, display.environment, 2, "--set", folder / "short", "--out", out, "--set", "title=a", command="film")
    refuse(tandem, display.environment, 2, "--site", "cube", "--out", out, "--site", "2", command="film")
    check(not out.exists(), "a refused film leaves nothing")


def refuse(tandem, environment, status, words, *options, command="view"):
    done = subprocess.run([tandem, command, *options], env=environment, capture_output=True, text=True,
                          timeout=PATIENCE, check=False)
    lines = done.stderr.strip().split("\n")
    check(done.returncode == status, f"{options}: status {done.returncode}, not {status}: {done.stderr}")
    check(len(lines) == 1 and words in lines[0], f"{options}: a line with '{words}', not {lines}")


def main():
    tandem, with_window = sys.argv[1:]
    worlds = Path(__file__).resolve().parents[2] / "demos" / "worlds"
    display = Display()
    try:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            push_and_switch(tandem, display, folder)
            view = View(tandem, display, folder, "crate", "--watch")
            first = view.wait_for("a world to watch", lambda note: note["frames"] > 0)
            view.wait_for("a hand that moves by itself", lambda note: abs(note["hip"][0] - first["hip"][0]) > 0.02)
            display.press("Escape")
            check(view.end() == 0, "Escape ends watching with status 0")
            view = View(tandem, display, folder, "touch", "--seconds", "2")
            check(view.end() == 0, "--seconds ends the window with status 0")
            host = subprocess.run([with_window, "2"], env=display.environment, capture_output=True, text=True,
                                  timeout=PATIENCE, check=True)
            check("status 0" in host.stdout, f"a host's own world in a window: {host.stdout}")
            meet_a_friend(tandem, worlds, display, folder)
            watch_a_room(tandem, worlds, display, folder)
            record_until_a_signal(tandem, display, folder)
            replay_a_run(tandem, worlds, display, folder)
            subprocess.run([tandem, "run", worlds / "cube.toml", "--set", "experiment.duration=1", "--out",
                            folder / "short", "--quiet"], check=True)
            film_a_run(tandem, display, folder)
            bad = folder / "bad.toml"
            bad.write_text("[object]\nmass = -1\n")
            refuse(tandem, display.environment, 2, "object.mass", bad)
            refuse(tandem, display.environment, 2, "worlds: ", "nowhere")
            refuse(tandem, display.environment, 2, "--second lever: no such device", "crate", "--second", "lever")
            refuse(tandem, display.environment, 2, "is user 1's device", "crate", "--device", "falcon",
                   "--second", "falcon")
            refuse(tandem, display.environment, 2, "user 2 is at another machine", "crate", "--second", "simulated",
                   "--site", "1", "--bind", ":0", "--peer", "127.0.0.1:9", "--key", folder / "key")
            refuse(tandem, display.environment, 2, "--watch", "crate", "--watch", "--device", "emulated")
            refuse(tandem, display.environment, 2, "belong together", "crate", "--site", "1")
            refuse(tandem, display.environment, 2, "--size", "crate", "--size", "7x7")
            refuse(tandem, display.environment, 1, "--status", "crate", "--status", folder / "no" / "file")
            without = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
            refuse(tandem, without, 1, "display", "crate")
    finally:
        display.end()


if __name__ == "__main__":
    main()
