#!/usr/bin/env python3
"""Draws velocity_estimators.svg beside itself. The numbers are of tandem_velocity_estimators."""

import pathlib
import re
import sys

HERE = pathlib.Path(__file__).parent
sys.path.insert(0, str(HERE.parents[1] / "demos/program/plot"))

from canvas import LEFT, PT, WIDTH, Sheet, line, points, set_axis, set_log_axis  # noqa: E402

# Lag at 3 Hz [ms], noise in a stroke of 100 mm/s with uneven, unstamped readings [mm/s], stiffest
# wall with forces a period late [N/m], name; then where names stand in the left and right panel.
FAMILIES = [
    ("first difference, and low-pass by cut-off", "#666666", "o", (6, 6), (-6, 6), [
        (0.5, 34.4, 14578, "difference"), (1.4, 15.0, 9957, "120 Hz"), (2.7, 8.3, 6801, "60 Hz"),
        (5.3, 4.4, 3839, "30 Hz"), (10.5, 2.5, 1970, "15 Hz")]),
    ("alpha-beta observer by memory", "#1f77b4", "s", (-6, -6), (6, -6), [
        (2.5, 6.6, 6183, "0.5"), (3.5, 4.3, 4645, "0.6"), (5.2, 2.6, 3173, "0.7")]),
    ("adaptive window of 16 ms by tolerance [counts]", "#2ca02c", "^", (6, 6), (6, 6), [
        (1.1, 23.1, 13253, "0.5"), (2.1, 19.8, 9957, "0.7"), (4.9, 7.5, 1791, "1"),
        (6.2, 1.8, 1628, "1.5")]),
    ("the same with a stamp error: usual, 8 ms", "#d62728", "o", (6, 7), (8, 0), [
        (3.3, 4.2, 7481, "usual"), (5.2, 2.7, 9052, "16 ms")])]


def draw():
    sheet = Sheet("", 420)
    for i, (text, colour, *_) in enumerate(FAMILIES):
        sheet.drawing.text((LEFT + i // 2 * 420) / WIDTH, 0.95 - 0.06 * (i % 2), text, color=colour,
                           va="center")
    for panel, (label, highest) in enumerate((("lag at 3 Hz [ms]", 12), (
            "stiffest calm wall, forces a period late [kN/m]", 16))):
        axes = sheet.panel(LEFT + panel * 420, 84, 380, 280, "", label,
                           "" if panel else "noise at 100 mm/s, uneven readings [mm/s]")
        set_axis(axes, "x", (0, highest), 50)
        set_log_axis(axes, "y", (1.2, 50), {tic: str(tic) for tic in (2, 5, 10, 20, 50)})
        for _, colour, marker, *offsets, rows in FAMILIES:
            x = [stiffness / 1e3 if panel else lag for lag, _, stiffness, _ in rows]
            axes.plot(x, [noise for _, noise, _, _ in rows],
                      **line(colour, 2) | points(colour, marker, 7, linestyle="-"))
            dx, dy = offsets[panel]
            for at, (_, noise, _, name) in zip(x, rows):
                axes.annotate(name, (at, noise), (dx * PT, dy * PT), textcoords="offset points",
                              size=12 * PT,
                              color=colour, ha="right" if dx < 0 else "left",
                              va="center" if dy == 0 else "top" if dy < 0 else "bottom")
    return sheet.drawing


if __name__ == "__main__":
    drawing, path = draw(), HERE / "velocity_estimators.svg"
    drawing.savefig(path, metadata={"Date": None, "Creator": None})
    path.write_text(re.sub(r"[ \t]+\n", "\n", path.read_text()))
    for preview in sys.argv[1:]:
        drawing.savefig(preview, dpi=144)
