"""Recorded scenes: frames and outlines."""

import itertools
import unittest

import numpy as np

from support import RDP, message_of, run_of

from scene import read_motion, rotations
from table import Table
from top_view import outline

BOX = {"site": 1, "role": "object", "shape": "box", "half_extents": [0.1, 0.1, 0.1]}
BALL = {"site": 1, "role": "device", "shape": "sphere", "radius": 0.05}
FLOOR = {"site": 1, "role": "obstacle", "shape": "box", "half_extents": [9, 9, 0.1],
         "motion": "static"}
HEADER = "t,site,body,x,y,z,qw,qx,qy,qz\n"


def motion_of(rows, *bodies):
    run = run_of(RDP, scene={"bodies": list(bodies)})
    return run, read_motion(Table(HEADER + rows, "scene.csv"), run.bodies)


class MotionTest(unittest.TestCase):
    ROWS = "0,1,0,1,2,3,1,0,0,0\n0,1,1,0,0,0,1,0,0,0\n0.5,1,1,4,0,0,1,0,0,0\n"

    def test_a_body_without_a_row_stays_where_it_was(self):
        _, motion = motion_of(self.ROWS, BOX, BALL)
        self.assertEqual(list(motion.times), [0, 0.5])
        self.assertEqual(motion.p[0].tolist(), [[1, 2, 3], [1, 2, 3]])
        self.assertEqual(motion.p[1].tolist(), [[0, 0, 0], [4, 0, 0]])

    def test_names_what_is_broken(self):
        for rows, bodies, message in [
                (self.ROWS, [BOX], 'line 3, column "body": 1 is not a body of summary.json'),
                (self.ROWS, [BOX] * 3, 'column "body": body 2 of summary.json never appears'),
                ("0,1,nan,1,2,3,1,0,0,0\n", [BOX],
                 'line 2, column "body": "nan" is not a finite number'),
                ("0,1,0,1,2,3,3,0,0,0\n", [BOX],
                 'line 2, columns "x" to "qz": not a finite position and unit quaternion')]:
            with self.subTest(message):
                self.assertEqual(message_of(lambda: motion_of(rows, *bodies)),
                                 f"scene.csv: {message}")

    def test_a_wide_floor_is_not_interesting(self):
        _, motion = motion_of("0,1,0,0,0,0,1,0,0,0\n0,1,1,0,0,-0.2,1,0,0,0\n", BOX, FLOOR)
        self.assertEqual(motion.interesting_bounds()[1].tolist(), [0.1, 0.1, 0.1])

    def test_rotations_turn_as_quaternions_do(self):
        half = np.sqrt(0.5)
        about_z = rotations(np.array([half, 0, 0, half]))
        np.testing.assert_allclose(about_z @ [1, 2, 3], [-2, 1, 3], atol=1e-15)

    def test_an_outline_holds_all_corners_and_touches_them(self):
        numbers = np.random.default_rng(5)
        for _ in range(50):
            q = numbers.normal(size=4)
            q /= np.linalg.norm(q)
            _, motion = motion_of("0,1,0,1,2,3," + ",".join(map(str, q)) + "\n", BOX)
            corners = np.array(list(itertools.product([-0.1, 0.1], repeat=3))) @ motion.r[0, 0].T
            corners = 1e3 * (corners + motion.p[0, 0])[:, :2]
            edge = outline(motion, 0, 0)
            sides = np.roll(edge, -1, axis=0) - edge
            normals = np.column_stack([sides[:, 1], -sides[:, 0]])  # outwards
            for point, normal in zip(edge, normals / np.linalg.norm(normals, axis=1)[:, None]):
                reach = (corners - point) @ normal
                self.assertAlmostEqual(reach.max(), 0, places=9)


if __name__ == "__main__":
    unittest.main()
