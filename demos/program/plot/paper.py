"""What the paper's equations give for runs with the paper's settings.

Li and Constantinescu 2009, equations (1) to (14), integrated at 2 us with the device force held
over 1 ms and packets at 128 Hz held until the next.
"""

import math

from runs import CONTACT, COOPERATION

# By kind, scheme, contact stiffness [N/m] and network delay [s]: numbers of the summary. What
# is not here the equations leave open: intermittent contact is chaotic, and only the size of count
# and force means something there.
_COOPERATION = ("coherency.mean_abs", "coherency.max_abs", "site1.coherency.received_mean",
                "site2.coherency.received_mean", "site1.force.mean")
_CONTACT = ("site1.force.max", "site1.contact_transitions", "site1.device_end")
_OUTCOMES = {
    (COOPERATION, "virtual_coupling", 4000, 0.05): (10.94e-3, 13.40e-3, 20.7e-3, 0.59e-3, 4.876),
    (COOPERATION, "kinematic_proxy", 4000, 0.05): (3.16e-3, 12.83e-3, 7.3e-3, 1.30e-3, 4.955),
    (COOPERATION, "remote_dynamic_proxy", 4000, 0.05):
        (6.31e-3, 10.07e-3, 12.7e-3, 0.40e-3, 4.921),
    (CONTACT, "kinematic_proxy", 2000, 0.1): (8.7, 25),
    (CONTACT, "kinematic_proxy", 2000, 0.2): (7.8, 23),
    (CONTACT, "kinematic_proxy", 4000, 0.1): (14.2, 88),
    (CONTACT, "remote_dynamic_proxy", 2000, 0.1): (3.52, 1, 0.1919),
    (CONTACT, "remote_dynamic_proxy", 2000, 0.2): (3.52, 1, 0.1150),
    (CONTACT, "remote_dynamic_proxy", 4000, 0.1): (3.60, 1, 0.1790)}

# Experiments I and II where they differ, then what both share.
_ASKED = {
    COOPERATION: {"experiment.duration": 1, "coordination.damping": 30, "site1.hand_force.0": 5,
                  "object.mass": 0.2, "object.damping": 0},
    CONTACT: {"experiment.duration": 2, "coordination.damping": 10, "site1.hand_force.0": 3}}
_SHARED = {
    "contact.damping": 1, "coordination.stiffness": 200, "proxy.mass": 0.1, "proxy.damping": 0,
    "device.mass": 0.1, "device.damping": 0.5, "site1.hand_force.1": 0, "site1.hand_force.2": 0,
    "site2.hand_force.0": 0, "site2.hand_force.1": 0, "site2.hand_force.2": 0,
    "network.rate": 128, "rates.haptic": 1000}
# Zero or not mentioned: what the paper does not have.
_ABSENT = ["network.jitter", "network.loss", "network.duplicate", "network.reorder",
           "world.gravity", "device.encoder_resolution",
           *(f"site{site}.start_offset.{axis}" for site in (1, 2) for axis in range(3))]


def _is_near(a, b):
    return math.isclose(a, b, rel_tol=1e-9, abs_tol=1e-9)


def _has_paper_settings(run):
    return (all(run.settings.get(f"{site}.hand") in (None, "", "constant")
                for site in ("site1", "site2"))
            and all(_is_near(run.setting(key), value)
                    for key, value in (_SHARED | _ASKED[run.kind]).items())
            and all(run.settings.get(key) in (None, 0.0) for key in _ABSENT))


def paper_outcome(run):
    """What the paper's equations give for this run: numbers by key of the summary. Empty if its
    settings are not theirs."""
    if run.kind in _ASKED and _has_paper_settings(run):
        for (kind, scheme, stiffness, delay), values in _OUTCOMES.items():
            if (kind, scheme) == (run.kind, run.scheme) and \
                    _is_near(run.setting("contact.stiffness"), stiffness) and \
                    _is_near(run.setting("network.delay"), delay):
                return dict(zip(_COOPERATION if kind == COOPERATION else _CONTACT, values))
    return {}
