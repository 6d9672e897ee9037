"""Pieces of animated SVG (SMIL): values that change over the frames of a loop."""

import numpy as np

_SHORTEST = 5.0  # a loop lasts at least this long [s]
_LONGEST_STRETCH = 90  # frames between two keys: bounds the search
_TOLERANCE = 0.2  # of a coordinate [px]
_SHADE_STEP = 0.01  # of a brightness


class LoopClock:
    """The clock that all animations of a picture share; a short recording is slowed down."""

    def __init__(self, times):
        self.begin, end = times[0], times[-1]
        self.length = end - self.begin if end > self.begin else 1.0  # of the recording [s]
        self.slowdown = max(1.0, _SHORTEST / self.length)
        self.phases = (np.asarray(times) - self.begin) / self.length  # of the frames, 0 to 1
        self.attributes = f'dur="{self.length * self.slowdown:.3f}s" repeatCount="indefinite"'


def key_frames(phases, values, tolerance):
    """Frames that suffice: in between, straight lines are within `tolerance` of every value."""
    def is_straight(begin, end):
        share = (phases[begin:end + 1] - phases[begin]) / (phases[end] - phases[begin])
        straight = values[begin] + share[:, None] * (values[end] - values[begin])
        return np.abs(values[begin:end + 1] - straight).max() <= tolerance

    last = len(values) - 1
    keys = [0]
    while keys[-1] < last:
        begin = keys[-1]
        end = begin + 1
        while end < min(last, begin + _LONGEST_STRETCH) and is_straight(begin, end + 1):
            end += 1
        keys.append(end)
    return keys


def _animation(clock, head, values, text, tolerance=_TOLERANCE):
    """Empty when nothing moves."""
    if np.abs(values - values[0]).max() <= tolerance:
        return ""
    keys = key_frames(clock.phases, values, tolerance)
    times = ";".join(f"{clock.phases[key]:.4g}" for key in keys)
    listed = ";".join(text(values[key]) for key in keys)
    return f'<{head} {clock.attributes} keyTimes="{times}" values="{listed}"/>'


def points_text(values):
    """ "12.3,4.5 6.7,8.9" for pairs of coordinates."""
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in np.reshape(values, (-1, 2)))


def shaded(colour, brightness):
    """`colour` (#rrggbb) with that brightness; 1 leaves it."""
    channels = (int(colour[i:i + 2], 16) for i in (1, 3, 5))
    return "#" + "".join(f"{min(max(int(value * brightness), 0), 255):02x}" for value in channels)


def animate_points(clock, values):
    return _animation(clock, 'animate attributeName="points"', values, points_text)


def animate_shift(clock, values):
    return _animation(clock, 'animateTransform attributeName="transform" type="translate"', values,
                      points_text)


def animate_fill(clock, colour, brightness):
    return _animation(clock, 'animate attributeName="fill"', brightness[:, None],
                      lambda value: shaded(colour, value[0]), _SHADE_STEP)


def animate_visibility(clock, begins, states):
    """From the phase `begins[k]` on, the state is `states[k]`."""
    changes = [k for k in range(len(states)) if k == 0 or states[k] != states[k - 1]]
    times = ";".join(f"{begins[k]:.4g}" for k in changes)
    values = ";".join("visible" if states[k] else "hidden" for k in changes)
    return (f'<animate attributeName="visibility" calcMode="discrete" {clock.attributes} '
            f'keyTimes="{times}" values="{values}"/>')
