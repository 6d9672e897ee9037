"""A moving picture of the scene at both sites: one SVG that loops and needs nothing else.

Layout [px]:

   site 1                          site 2                       t = 1.2 s
   +---------------------------+   +---------------------------+
   |  floor grid, then bodies, |   |                           |
   |  farthest first           |   |                           |
   +---------------------------+   +---------------------------+
   |-----o---------------------------------------------| time bar
"""

from html import escape
from itertools import product

import numpy as np

from canvas import WIDTH, Figure, nice_step
from scene import Motion
from smil import (LoopClock, animate_fill, animate_points, animate_shift, animate_visibility,
                  points_text, shaded)
from words import body_colour, scheme_label

_MARGIN, _SITE_WIDTH, _TOP, _TIME_BAR = 12, 430, 44, 56  # [px]
_VIEW = np.array([0.32, -0.78, 0.62]) / np.linalg.norm([0.32, -0.78, 0.62])  # towards the viewer
_RIGHT = np.cross([0, 0, 1], _VIEW) / np.linalg.norm(np.cross([0, 0, 1], _VIEW))
_SCREEN = np.array([_RIGHT, -np.cross(_VIEW, _RIGHT)])  # x to the right, y down
_LIGHT = np.array([-0.35, -0.45, 0.85]) / np.linalg.norm([-0.35, -0.45, 0.85])


class Projection:
    """Parallel projection from above one side, fitted into a picture of the site's width."""

    def __init__(self, low, high, left):
        corners = np.array(list(product(*zip(low, high)))) @ _SCREEN.T
        size = np.ptp(corners, axis=0)
        self.scale = _SITE_WIDTH / size[0]  # [px/m]
        self.height = self.scale * size[1]
        self.origin = np.array([left, _TOP]) - self.scale * corners.min(axis=0)

    def __call__(self, p):
        return self.origin + self.scale * p @ _SCREEN.T


def hides(low, high):
    """True at [frame, i, j] where body i can hide body j; boxes as (frame, body, axis).

    An axis on which they lie apart decides; axes that contradict each other mean that neither can.
    Bodies that touch may overlap a little. Of bodies that overlap, the nearer centre is in front.
    """
    least = (high - low).min(axis=-1)
    slack = 0.2 * np.minimum(least[:, :, None], least[:, None, :])[..., None]
    is_above = low[:, :, None] >= high[:, None] - slack
    is_below = low[:, None] >= high[:, :, None] - slack
    is_first = np.where(_VIEW > 0, is_above, is_below).any(axis=-1)
    is_second = np.where(_VIEW > 0, is_below, is_above).any(axis=-1)
    depth = (low + high) @ _VIEW
    return np.where(is_first == is_second, ~is_first & (depth[:, :, None] > depth[:, None]),
                    is_first)


def drawing_orders(low, high):
    """Pairs of a frame and the order that is right from there on, farthest first."""
    hiding, depth = hides(low, high), (low + high) @ _VIEW
    orders = []
    for frame, front in enumerate(hiding):
        if orders and not np.triu(front[np.ix_(orders[-1][1], orders[-1][1])], 1).any():
            continue
        rest, order = list(np.argsort(depth[frame], kind="stable")), []
        while rest:  # next is whatever hides none of the rest; in a cycle, the farthest
            order.append(next((i for i in rest if not front[i, rest].any()), rest[0]))
            rest.remove(order[-1])
        if not orders or orders[-1][1] != order:
            orders.append((frame, order))
    return orders


def _cut_still_boxes(motion, low, high):
    """Cuts boxes that stand still, such as a wide floor, down to the bounds. Returns the bodies
    that are left and their motion."""
    kept, p = [], motion.p.copy()
    for b, body in enumerate(motion.bodies):
        if body.is_static and body.is_box and abs(motion.q[b, 0, 0]) > 1 - 1e-12:
            inside = np.maximum(motion.low[b, 0], low), np.minimum(motion.high[b, 0], high)
            if (inside[1] <= inside[0]).any():
                continue
            p[b] = 0.5 * (inside[0] + inside[1])
            body = type(body)(**vars(body) | {"half_extents": 0.5 * (inside[1] - inside[0])})
        kept.append((b, body))
    places = [b for b, _ in kept]
    return Motion([body for _, body in kept], motion.times, p[places], motion.q[places])


def _faces(motion, b, projection):
    """For each face of a box that is ever seen: corners on the screen, brightness and whether it
    is seen, frame by frame."""
    signs = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    for axis, side in product(range(3), (-1, 1)):
        corners = np.full((4, 3), float(side))
        corners[:, [(axis + 1) % 3, (axis + 2) % 3]] = signs
        normals = side * motion.r[b, :, :, axis]
        is_seen = normals @ _VIEW > 0
        if is_seen.any():
            turned = (corners * motion.bodies[b].half_extents) @ motion.r[b].transpose(0, 2, 1)
            yield (projection(motion.p[b][:, None] + turned),
                   0.62 + 0.38 * np.maximum(0, normals @ _LIGHT), is_seen)


def _turning_faces(motion, b, projection, clock):
    """Faces turned away shrink to a point, so that what is left is never hidden by another face."""
    faces, colour = "", body_colour(motion.bodies[b])
    for screen, light, is_seen in _faces(motion, b, projection):
        screen[~is_seen] = screen[~is_seen].mean(axis=1, keepdims=True)
        values = screen.reshape(len(screen), 8)
        faces += (f'<polygon points="{points_text(values[0])}" fill="{shaded(colour, light[0])}">'
                  f"{animate_points(clock, values)}{animate_fill(clock, colour, light)}</polygon>")
    return faces


def _shifted_shape(motion, b, projection, clock):
    """A body that does not turn is one shape that is shifted."""
    body, colour = motion.bodies[b], body_colour(motion.bodies[b])
    centres = projection(motion.p[b])
    if body.is_box:
        shape = "".join(
            f'<polygon points="{points_text(screen[0] - centres[0])}" '
            f'fill="{shaded(colour, light[0])}"></polygon>'
            for screen, light, is_seen in _faces(motion, b, projection) if is_seen[0])
    else:
        r = body.radius * projection.scale
        shape = (f'<circle r="{r:.2f}" fill="{colour}"/><circle cx="{-0.3 * r:.2f}" '
                 f'cy="{-0.35 * r:.2f}" r="{0.32 * r:.2f}" fill="#fff" fill-opacity="0.4" '
                 'stroke="none"/>')
    return (f'<g transform="translate({points_text(centres[0])})">{shape}'
            f"{animate_shift(clock, centres)}</g>")


def _dash(body):
    """A user's proxy is told from the user by its dashed outline."""
    return ' stroke-dasharray="4 3"' if body.role == "proxy" else ""


def _draw_body(motion, b, projection, clock, name):
    body = motion.bodies[b]
    opacity = 0.65 if body.role == "proxy" else 0.55 if body.is_static else 1
    draw = _turning_faces if body.is_box and motion.does_rotate(b) else _shifted_shape
    return (f'<g id="{name}" stroke="#222" stroke-width="0.8" opacity="{opacity}"{_dash(body)}>'
            f"<title>{escape(body.name)}</title>{draw(motion, b, projection, clock)}</g>\n")


def _draw_ring(motion, b, projection, clock):
    """The outline of a user, which shows through the bodies before it."""
    body, centres = motion.bodies[b], projection(motion.p[b])
    return (f'<circle r="{body.radius * projection.scale:.2f}" fill="none" '
            f'stroke="{body_colour(body)}" stroke-width="1.2"{_dash(body)} '
            f'transform="translate({points_text(centres[0])})">{animate_shift(clock, centres)}'
            "</circle>\n")


def _draw_site(motion, site, projection, clock, prefix):
    """Bodies in their order. Where it changes, a body stands at every place that it ever takes, and
    is visible at one of them at a time."""
    members = [b for b, body in enumerate(motion.bodies) if body.site == site]
    if not members:
        return ""
    orders = drawing_orders(motion.low[members].transpose(1, 0, 2),
                            motion.high[members].transpose(1, 0, 2))
    begins = [clock.phases[frame] for frame, _ in orders]
    definitions, places = {}, ""
    for place, m in product(range(len(members)), range(len(members))):
        is_here = [order[place] == m for _, order in orders]
        if not any(is_here):
            continue
        name = f"{prefix}-body{members[m]}"
        body = _draw_body(motion, members[m], projection, clock, name)
        if all(is_here):
            places += body
            continue
        definitions[name] = body
        places += (f'<use href="#{name}" visibility="{"visible" if is_here[0] else "hidden"}">'
                   f"{animate_visibility(clock, begins, is_here)}</use>\n")
    places += "".join(_draw_ring(motion, b, projection, clock) for b in members
                      if motion.bodies[b].is_user and not motion.bodies[b].is_box)
    return f"<defs>{''.join(definitions.values())}</defs>\n{places}"


def _floor_grid(low, high, step, projection):
    xs, ys = (np.arange(low[axis], high[axis] + 0.5 * step, step) for axis in (0, 1))
    ends = [((x, low[1]), (x, high[1])) for x in xs] + [((low[0], y), (high[0], y)) for y in ys]
    path = ""
    for line in ends:
        a, b = (points_text(projection(np.array([*end, low[2]]))) for end in line)
        path += f"M{a}L{b}"
    return f'<path d="{path}" stroke="#cfd6dc" stroke-width="1" fill="none"/>\n'


def _time_labels(clock):
    step = max(0.1, nice_step(clock.length, 100))
    labels = ""
    for i in range(int(clock.length / step + 1e-9) + 1):
        begin, end = i * step / clock.length, min(1.0, (i + 1) * step / clock.length)
        if begin >= 1:
            break
        begins, states = ([0.0, begin, end], [False, True, False]) if i else \
            ([0.0, end], [True, False])
        labels += (f'<text x="{WIDTH - _MARGIN}" y="28" text-anchor="end" '
                   f'visibility="{"hidden" if i else "visible"}">t = {clock.begin + i * step:.1f} s'
                   f"{animate_visibility(clock, begins, states)}</text>\n")
    return labels


def _time_bar(clock, y):
    left, right = 40, WIDTH - 40
    bar = (f'<path d="M{left},{y:.1f}H{right}" stroke="#999" stroke-width="3" '
           'stroke-linecap="round"/>\n')
    for t in np.arange(0, 1.02 * clock.length, nice_step(clock.length, 8)):
        bar += (f'<text x="{left + (right - left) * t / clock.length:.1f}" y="{y + 24:.1f}" '
                f'text-anchor="middle" font-size="13" fill="#555">{clock.begin + t:g} s</text>\n')
    return bar + (f'<circle cx="{left}" cy="{y:.1f}" r="7" fill="#222"><animate attributeName="cx" '
                  f'{clock.attributes} values="{left};{right}"/></circle>\n')


def animate_scene(run, motion, name):
    """The scene at both sites, side by side, seen from above one side."""
    clock = LoopClock(motion.times)
    low, high = motion.interesting_bounds()
    margin = 0.12 * (high - low)[:2].max() * np.array([1, 1, 0.1])
    low, high = low - margin, high + margin * [1, 1, 0]
    step = nice_step((high - low)[:2].max(), 10)
    low[:2], high[:2] = np.floor(low[:2] / step) * step, np.ceil(high[:2] / step) * step
    motion = _cut_still_boxes(motion, low, high)

    sites = ""
    for site, left in ((1, _MARGIN), (2, WIDTH - _MARGIN - _SITE_WIDTH)):
        projection = Projection(low, high, left)
        sites += (f'<text x="{left}" y="28">site {site}</text>\n'
                  + _floor_grid(low, high, step, projection)
                  + _draw_site(motion, site, projection, clock, f"{name}-{site}"))
    title = f"The scene at both sites ({scheme_label(run.scheme)})"
    height = int(_TOP + projection.height + _TIME_BAR)
    svg = (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" role="img" '
           f'font-family="sans-serif" font-size="17"><title>{title}</title>\n'
           f'<rect width="100%" height="100%" fill="#fff"/>\n{sites}{_time_labels(clock)}'
           f"{_time_bar(clock, _TOP + projection.height + 18)}</svg>\n")
    speed = f"slowed down {clock.slowdown:.1f} times" if clock.slowdown > 1 else \
        "at the speed of the run"
    return Figure(
        name, title, f"Each site’s own copy of the scene, {speed}; one cell of the floor is "
        f"{step * 1e3:g} mm. A user’s proxy at the other site is pale with a dashed outline; users "
        "behind a body show as a ring.", height, svg=svg)
