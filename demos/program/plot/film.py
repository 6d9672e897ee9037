"""Films of recorded runs: what both users saw, side by side, drawn by `tandem-view`."""

import os
import subprocess
import tempfile

import numpy as np
from PIL import Image

from words import scheme_label

_WIDTH, _HEIGHT = 448, 280  # of one user's picture [px]
_GAP = 4  # between the two [px]
_MOST_PICTURES = 60
_SHORTEST = 5.0  # a film lasts at least this long [s]
_LARGEST = 300_000  # of a file [bytes]
_UNCHANGED = 255  # the colour of a pixel that is as it was; the others are before it

_program = ""


def use_program(path):
    """Tells which program draws; an empty path: there is none, and reports have no films."""
    global _program
    _program = path


def can_film():
    return bool(_program)


class Film:
    """A moving picture of the report: NAME.gif."""

    suffix = ".gif"
    width, height = 2 * _WIDTH + _GAP, _HEIGHT  # [px]

    def __init__(self, run, times, name):
        self.run, self.name = run, name
        self.length = times[-1] - times[0]  # of the recording [s]
        self.slowdown = max(1.0, _SHORTEST / self.length) if self.length > 0 else 1.0
        speed = f"slowed down {self.slowdown:.1f} times" if self.slowdown > 1 else \
            "at the speed of the run"
        self.title = f"What {'both users' if run.sites == 2 else 'users 1 and 2'} saw ({scheme_label(run.scheme)})"
        self.caption = (
            f"What user 1 (left) and user 2 (right) saw, {speed}. The own hand is blue, the other "
            "user’s is orange, and an arrow is the force on the hand. An orange frame is the "
            "other site’s copy, where it is more than 1 mm away.")

    def save(self, folder):
        """Writes the film. Returns a line that says why there is none; empty when there is one."""
        with tempfile.TemporaryDirectory() as drafts:
            pictures = []
            for site in (1, 2):
                draft = os.path.join(drafts, str(site))
                problem = _draw_pictures(self.run.folder, site, self._rate(), draft)
                if problem:
                    return f"the report has no films: {problem}"
                pictures.append(sorted(os.path.join(draft, name) for name in os.listdir(draft)))
            _save_gif(list(zip(*pictures)), self.length * self.slowdown,
                      os.path.join(folder, self.name + self.suffix))
        return ""

    def _rate(self):
        """Pictures for each recorded second: all that there are of a short run."""
        return min(30.0, max(1.0, _MOST_PICTURES / self.length)) if self.length > 0 else 30.0


def _draw_pictures(run_folder, site, rate, draft):
    """Pictures of one user into a folder. Returns what went wrong."""
    done = subprocess.run(
        [_program, "film", run_folder, "--site", str(site), "--out", draft, "--size",
         f"{_WIDTH}x{_HEIGHT}", "--rate", f"{rate:g}", "--quiet"], capture_output=True, text=True, check=False)
    return "" if done.returncode == 0 else \
        done.stderr.strip().removeprefix("tandem: ") or f"{_program} broke off"


def _join(pair):
    """Both users' pictures side by side."""
    joined = Image.new("RGB", (Film.width, Film.height), "white")
    for place, path in enumerate(pair):
        with Image.open(path) as picture:
            joined.paste(picture.convert("RGB"), (place * (_WIDTH + _GAP), 0))
    return joined


def _save_gif(pairs, length, path):
    """Leaves out pictures until the file is small enough."""
    step = 1
    while True:
        frames = _stored_frames([_join(pair) for pair in pairs[::step]])
        frames[0].save(path, save_all=True, append_images=frames[1:], loop=0, optimize=False,
                       disposal=1, transparency=_UNCHANGED,
                       duration=round(1e3 * length / len(frames)))
        if os.path.getsize(path) <= _LARGEST or step >= len(pairs):
            return
        step *= 2


def _stored_frames(pictures):
    """Each picture in a few colours; pixels that are as in the one before are left out."""
    # One palette for all, so that what stands still has equal pixels.
    palette = pictures[len(pictures) // 2].quantize(
        _UNCHANGED, Image.Quantize.MEDIANCUT, kmeans=3, dither=Image.Dither.NONE)
    colours = palette.getpalette()[:3 * _UNCHANGED]
    colours += [0] * (3 * _UNCHANGED - len(colours)) + [255, 0, 255]
    frames, before = [], None
    for picture in pictures:
        now = np.asarray(picture.quantize(palette=palette, dither=Image.Dither.NONE))
        stored = now if before is None else np.where(now == before, _UNCHANGED, now)
        frames.append(Image.fromarray(stored.astype(np.uint8), "P"))
        frames[-1].putpalette(colours)
        before = now
    return frames
