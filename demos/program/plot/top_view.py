"""The scene from above, to scale: start, middle and end at both sites."""

import numpy as np
from matplotlib.colors import to_rgba

from canvas import LEFT, Figure, frame as draw_frame, line, points, set_axis
from words import body_colour, scheme_label, user_colour

_WIDTH, _GAP, _TOP, _ROW_GAP = 240, 41, 98, 36  # of panels [px]


class Camera:
    """Views of one size at three moments.

    When the bodies travel far along an axis, each view goes with the bodies of its moment.
    """

    def __init__(self, motion):
        margin, far = 1.12, 4.0  # far: travel against the size of the group of bodies
        count = len(motion.times)
        self.frames = [0, count // 2, count - 1]
        moments = np.array([motion.bounds(slice(f, f + 1)) for f in self.frames])
        low, high = motion.bounds()
        shown = np.array(motion.interesting_bounds())
        size = (moments[:, 1] - moments[:, 0]).max(axis=0)
        moves = (high - low > far * size)[:2]
        size = np.where(moves, size[:2], (shown[1] - shown[0])[:2])
        scale = _WIDTH / (margin * max(size[0], 0.5 * size[1]))  # [px/m]
        self.panel_height = float(np.clip(scale * margin * size[1], 100, 2.2 * _WIDTH))
        half = 0.5 * np.array([_WIDTH, self.panel_height]) / scale
        centres = [np.where(moves, moment.mean(axis=0)[:2], shown.mean(axis=0)[:2])
                   for moment in moments]
        self.views = [1e3 * np.array([centre - half, centre + half]).T for centre in centres]
        self.moves_in_y = moves[1]  # then every panel needs its own tic labels


def outline(motion, b, frame):
    """Corners of a body as seen from above [mm]."""
    body, centre = motion.bodies[b], motion.p[b, frame, :2]
    if not body.is_box:
        angle = np.linspace(0, 2 * np.pi, 40, endpoint=False)
        return 1e3 * (centre + body.radius * np.column_stack([np.cos(angle), np.sin(angle)]))
    # A box casts the sum of its three edges as a shadow: they follow each other by angle.
    edges = (motion.r[b, frame][:2] * body.half_extents).T
    edges[(edges[:, 1] < 0) | (edges[:, 1] == 0) & (edges[:, 0] < 0)] *= -1
    edges = edges[np.argsort(np.arctan2(edges[:, 1], edges[:, 0]))]
    return 1e3 * (centre - edges.sum(axis=0) + 2 * np.cumsum([*edges, *-edges], axis=0))


def _draw_bodies(axes, motion, site, frame):
    """From below: what stands still, the ways of users, other bodies by height, users."""
    def height(b):
        return motion.bodies[b].is_user, motion.high[b, frame, 2]

    members = [b for b, body in enumerate(motion.bodies) if body.site == site]
    for order, b in enumerate(sorted(members, key=height)):
        body, colour = motion.bodies[b], body_colour(motion.bodies[b])
        is_proxy = body.role == "proxy"
        if body.is_user and frame > 0:
            way = 1e3 * motion.p[b, :frame + 1, :2]
            axes.plot(*way.T, zorder=20, **line(colour, 1.8, (5, 4) if is_proxy else None))
        corners = outline(motion, b, frame)
        face = to_rgba(colour, 0.45 if is_proxy or body.is_static else 0.9)
        axes.fill(*corners.T, facecolor=face, edgecolor="#333333", linewidth=0.75,
                  linestyle=(0, (3, 2.25)) if is_proxy else "-",
                  zorder=order / 100 + (3 if body.is_static else 21))


def top_view(run, motion, name):
    camera = Camera(motion)

    def paint(sheet):
        roles = {body.role: body_colour(body) for body in motion.bodies}
        sheet.legend([(f"user {user}", points(user_colour(user), "o", 13))
                      for user in range(1, run.sites + 1)] +
                     [(role, points(roles[role], "s", 13))
                      for role in ("object", "neighbour", "obstacle") if role in roles])
        for site in (1, 2):
            for m, frame in enumerate(camera.frames):
                axes = sheet.panel(LEFT + m * (_WIDTH + _GAP),
                                   _TOP + (site - 1) * (camera.panel_height + _ROW_GAP), _WIDTH,
                                   camera.panel_height, f"site {site}, {motion.times[frame]:.2f} s",
                                   "x [mm]" if site == 2 else "", "" if m else "y [mm]")
                draw_frame(axes)
                x, y = camera.views[m]
                set_axis(axes, "x", x, 46, site == 2)
                set_axis(axes, "y", y, 20, m == 0 or camera.moves_in_y)
                _draw_bodies(axes, motion, site, frame)

    return Figure(
        name, f"The scene from above, to scale ({scheme_label(run.scheme)})",
        "Each site’s own copy of the scene at the start, the middle and the end. A user’s proxy at "
        "the other site is pale with a dashed outline; lines show the ways of user (solid) and "
        "proxy (dashed) so far.", int(_TOP + 2 * camera.panel_height + _ROW_GAP + 58), paint)
