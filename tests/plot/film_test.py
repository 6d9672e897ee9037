"""Films of the report: made from pictures that a program draws, small, and left out where it cannot."""

import sys
import unittest

import numpy as np
from PIL import Image

from support import RDP, FolderTest, run_of

import film
from film import Film
from page import figure

# Draws a square that moves, as `tandem-view film RUN --out FOLDER` does.
DRAWER = f"""#!{sys.executable}
import os, sys
from PIL import Image
folder, site = sys.argv[sys.argv.index("--out") + 1], int(sys.argv[sys.argv.index("--site") + 1])
width, height = map(int, sys.argv[sys.argv.index("--size") + 1].split("x"))
os.makedirs(folder)
for i in range(12):
    picture = Image.new("RGBA", (width, height), (200, 200, 190, 255))
    picture.paste((250, 10 * site, 0, 255), (10 * i, 20, 10 * i + 30, 50))
    picture.save(os.path.join(folder, f"frame_{{i:05}}.png"))
"""
BROKEN = f"""#!{sys.executable}
import sys
sys.exit("tandem: no OpenGL 3.3; install libgl1-mesa-dri")
"""


class FilmTest(FolderTest):
    def setUp(self):
        super().setUp()
        self.addCleanup(film.use_program, "")

    def use(self, script):
        program = self.folder / "drawer"
        program.write_text(script)
        program.chmod(0o755)
        film.use_program(str(program))

    def save(self):
        made = Film(run_of(RDP), [0.0, 1.0], "film")
        return made, made.save(str(self.folder))

    def test_shows_both_users_and_every_picture(self):
        self.use(DRAWER)
        made, problem = self.save()
        self.assertEqual(problem, "")
        self.assertIn("slowed down 5.0 times", made.caption)
        with Image.open(self.folder / "film.gif") as gif:
            self.assertEqual((gif.n_frames, gif.size), (12, (made.width, made.height)))
            self.assertEqual(gif.info["loop"], 0)
            for frame in (0, 5, 11):
                gif.seek(frame)
                pixels = np.asarray(gif.convert("RGB")).astype(int)
                half = made.width // 2
                for left, red in ((10 * frame, (250, 10, 0)), (half + 2 + 10 * frame, (250, 20, 0))):
                    self.assertLess(abs(pixels[35, left + 5] - red).max(), 12, (frame, left))
                    if left not in (0, half + 2):  # where the square was
                        self.assertLess(abs(pixels[35, left - 5] - (200, 200, 190)).max(), 12)
        self.assertIn("data:image/gif;base64,", figure(made, str(self.folder)))

    def test_is_small(self):
        self.use(DRAWER.replace("picture.save", "picture.paste(Image.effect_noise((width, height), 90 + i))\n"
                                "    picture.save"))
        self.assertEqual(self.save()[1], "")
        with Image.open(self.folder / "film.gif") as gif:
            self.assertLess(gif.n_frames, 12)
        self.assertLess((self.folder / "film.gif").stat().st_size, 600_000)

    def test_a_program_that_cannot_draw_leaves_it_out(self):
        self.use(BROKEN)
        made, problem = self.save()
        self.assertEqual(problem, "the report has no films: no OpenGL 3.3; install libgl1-mesa-dri")
        self.assertEqual(figure(made, str(self.folder)), "")

    def test_without_a_program_there_are_none(self):
        self.assertFalse(film.can_film())


if __name__ == "__main__":
    unittest.main()
