#!/usr/bin/env python3
"""Drives `tandem view` on a display of its own as a user does: pushes, switches the scheme, ends. Then what goes wrong:
no display, a bad world, a bad option.

Usage: window_test.py TANDEM WITH_WINDOW
"""

import json
import os
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
        # The window looks at the keys once a frame.
        self.do("keydown", key, "sleep", 0.3, "keyup", key)

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
    view = View(tandem, display, folder, "cube", "--set", "site2.hand_waypoints=[[0,0,0,0]]", "--size", "1280x800",
                "--screenshot", folder / "last.png")
    first = view.wait_for("the first picture", lambda note: note["frames"] > 5)
    check(first["scheme"] == "remote_dynamic_proxy", "the world's scheme at first")
    # From the user's hand to the right, where the cube is.
    display.do("mousemove", 560, 400)
    for _ in range(25):
        display.do("mousemove_relative", 8, 3, "sleep", 0.05)
    moved = view.wait_for("a cube that moves", lambda note: note["object"][0] - first["object"][0] > 0.01)
    check(max(note["force"] for note in view.notes()) > 0.5, "the push is felt")
    check(moved["status"] == 0, "no fault while pushing")
    display.press("1")
    view.wait_for("another scheme", lambda note: note["scheme"] != "remote_dynamic_proxy" and note["time"] > 0.2)
    display.press("Escape")
    check(view.end() == 0, "Escape ends the window with status 0")
    check((folder / "last.png").read_bytes()[:4] == b"\x89PNG", "a screenshot")


def refuse(tandem, environment, status, words, *options):
    done = subprocess.run([tandem, "view", *options], env=environment, capture_output=True, text=True,
                          timeout=PATIENCE, check=False)
    lines = done.stderr.strip().split("\n")
    check(done.returncode == status, f"{options}: status {done.returncode}, not {status}: {done.stderr}")
    check(len(lines) == 1 and words in lines[0], f"{options}: a line with '{words}', not {lines}")


def main():
    tandem, with_window = sys.argv[1:]
    display = Display()
    try:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            push_and_switch(tandem, display, folder)
            view = View(tandem, display, folder, "touch", "--seconds", "2")
            check(view.end() == 0, "--seconds ends the window with status 0")
            host = subprocess.run([with_window, "2"], env=display.environment, capture_output=True, text=True,
                                  timeout=PATIENCE, check=True)
            check("status 0" in host.stdout, f"a host's own world in a window: {host.stdout}")
            bad = folder / "bad.toml"
            bad.write_text("[object]\nmass = -1\n")
            refuse(tandem, display.environment, 2, "object.mass", bad)
            refuse(tandem, display.environment, 2, "worlds: ", "nowhere")
            refuse(tandem, display.environment, 2, "--size", "crate", "--size", "7x7")
            refuse(tandem, display.environment, 1, "--status", "crate", "--status", folder / "no" / "file")
            without = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
            refuse(tandem, without, 1, "display", "crate")
    finally:
        display.end()


if __name__ == "__main__":
    main()
