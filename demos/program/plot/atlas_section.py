"""The report's section on stability: what is said of its figures, and the figures."""

from atlas_figures import (damping_figure, fine_figure, limits_figure, touch_figure,
                           users_figure)
from atlas_maps import map_figure

_MAPS = (
    "Virtual coupling is stable below a coordination stiffness that falls with the delay. A "
    "kinematic proxy ties contact itself to the delay, so there the contact stiffness decides. "
    "Dynamic proxies let contact be stiff at any delay, but may still grow slowly.")
_DAMPING = (
    "Friction of the devices calms every scheme. How much is needed rises with the delay and levels "
    "off; a kinematic proxy needs several times more than a dynamic one.")
_USERS = (
    "By the sum, the dampers of many couplers make a wall of each copy. By average they do not, as "
    "long as a proxy is 1/(N−1) of a user: whole proxies outweigh the copy that they push.")
_LIMITS = (
    "Criteria that ask for passivity, or for damping to the ground, allow far less than is stable. "
    "Masses and delayed couplers come close. A wall’s rule knows nothing of the delay.")
_FINE = (
    "A packet’s age goes up and down by a packet period, and growth with it. A border of the delay "
    "is no single number.")

_TOUCH = (
    "A kinematic proxy is a wall until its user answers. Sampling makes a stiff wall give back more "
    "than it should: above 1 each touch gains energy.")


def _numbered(make, atlases, curves, name):
    """A figure for each scenario that has these curves."""
    members = [atlas for atlas in atlases if curves in atlas.curves]
    return [make(atlas, f"{name}-{number}") for number, atlas in enumerate(members, 1)]


def _together(make, atlases, curves, name):
    """One figure for all scenarios that have these curves."""
    members = [atlas for atlas in atlases if curves in atlas.curves]
    return [make(members, name)] if members else []


def stability_figures(atlases):
    """Pairs of a paragraph and its figures."""
    parts = [
        (_MAPS, [map_figure(atlas, f"stability-map-{number}")
                 for number, atlas in enumerate(atlases, 1)]),
        (_DAMPING, _together(damping_figure, atlases, "damping", "stability-damping")),
        (_USERS, _numbered(users_figure, atlases, "users", "stability-users")),
        (_LIMITS, _numbered(limits_figure, atlases, "contact_limits", "stability-limits")),
        (_FINE, _together(fine_figure, atlases, "fine", "stability-fine")),
        (_TOUCH, _numbered(touch_figure, atlases, "touch", "stability-touch"))]
    return [(text, figures) for text, figures in parts if figures]
