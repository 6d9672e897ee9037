"""The recorded motion of every body of a run, from scene.csv."""

import os

import numpy as np

from table import UsageError, read_table


class Motion:
    """`times` of the frames [s]; positions `p` [m] and rotation matrices `r`, by body and frame,
    in the scene's frame."""

    def __init__(self, bodies, times, p, q):
        self.bodies, self.times, self.p, self.q = bodies, times, p, q
        self.r = rotations(q)
        # Smallest axis-aligned box around each body at each frame [m].
        reach = np.array([np.abs(r) @ body.half_extents if body.is_box else
                          np.full((len(times), 3), body.radius) for body, r in zip(bodies, self.r)])
        self.low, self.high = p - reach, p + reach

    def bounds(self, frames=slice(None)):
        """What the moving bodies reach in some frames: lowest and highest corner [m]."""
        moves = [not body.is_static for body in self.bodies]
        if not any(moves):
            moves = [True] * len(moves)
        return self.low[moves, frames].min(axis=(0, 1)), self.high[moves, frames].max(axis=(0, 1))

    def interesting_bounds(self):
        """All that the moving bodies reach, and what stands still near them, but for floors and
        walls that are much larger."""
        low, high = moving_low, moving_high = self.bounds()
        reach = (high - low).max()
        for b, body in enumerate(self.bodies):
            if not body.is_static:
                continue
            is_large = (self.high[b, 0] - self.low[b, 0]).max() > 2 * reach
            away = 0.5 * (self.low[b, 0] + self.high[b, 0] - moving_low - moving_high)
            if not is_large and np.linalg.norm(away) <= 1.5 * reach:
                low, high = np.minimum(low, self.low[b, 0]), np.maximum(high, self.high[b, 0])
        return low, high


def rotations(q):
    """Rotation matrices of unit quaternions w, x, y, z in the last dimension."""
    w, x, y, z = np.moveaxis(q, -1, 0)
    rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def _refuse_first(table, is_wrong, problem):
    rows = np.flatnonzero(is_wrong)
    if len(rows):
        raise UsageError(f"{table.source}: line {rows[0] + 2}, {problem(rows[0])}")


def read_motion(table, bodies):
    """A later time begins a new frame; a body without a row in a frame stays where it was."""
    t, index = table["t"], table["body"]
    values = np.column_stack([table[name] for name in ("x", "y", "z", "qw", "qx", "qy", "qz")])
    _refuse_first(table, ~((index >= 0) & (index < len(bodies))), lambda row:
                  f'column "body": {index[row]:g} is not a body of summary.json')
    length = np.linalg.norm(values[:, 3:], axis=1)
    _refuse_first(table, ~(np.isfinite(values).all(axis=1) & (length > 0.5) & (length < 2)),
                  lambda row: 'columns "x" to "qz": not a finite position and unit quaternion')
    values[:, 3:] /= length[:, None]
    begins = np.concatenate([[True], t[1:] > np.fmax.accumulate(t)[:-1]])
    frame, body = np.cumsum(begins) - 1, index.astype(int)
    poses = np.zeros((len(bodies), frame[-1] + 1, 7))
    poses[..., 3] = 1
    for b in range(len(bodies)):
        rows = np.flatnonzero(body == b)
        if not len(rows):
            raise UsageError(f'{table.source}: column "body": body {b} of summary.json never '
                             "appears")
        latest = np.searchsorted(frame[rows], np.arange(frame[-1] + 1), side="right") - 1
        poses[b, latest >= 0] = values[rows[latest[latest >= 0]]]
    return Motion(bodies, t[begins], poses[..., :3], poses[..., 3:])


def load_motion(run):
    return read_motion(read_table(os.path.join(run.folder, "scene.csv")), run.bodies)
