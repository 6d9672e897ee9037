"""Words, colours and number formats that every figure and table of a report shares."""

import math

# The paper's three in its order; those of the program that are built in beside them come after.
SCHEMES = ["virtual_coupling", "kinematic_proxy", "remote_dynamic_proxy"]

# From the Okabe-Ito set, which stays apart under the common kinds of colour blindness.
_COLOURS = ["#e69f00", "#0072b2", "#009e73", "#d55e00", "#000000"]
_MARKERS = ["s", "^", "o", "x"]
USER_COLOURS = {1: "#444444", 2: "#cc79a7", 3: "#0072b2", 4: "#e69f00", 5: "#009e73", 6: "#d55e00",
                7: "#56b4e9", 8: "#7a3e9d"}

# Names of gains on axes, their unit there, and that unit for one of SI.
GAIN_LABELS = {
    "coordination.stiffness": ("coordination stiffness K_t", "N/m", 1),
    "coordination.damping": ("coordination damping B_t", "N s/m", 1),
    "contact.stiffness": ("contact stiffness K_vc", "N/m", 1),
    "contact.damping": ("contact damping B_vc", "N s/m", 1),
    "device.damping": ("device damping b_dev", "N s/m", 1),
    "network.delay": ("delay T_d", "ms", 1000)}

DIGITS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")  # to raised ones

# Settings with a name of their own; others are called by their key.
_SETTINGS = {
    "contact.stiffness": "N/m", "contact.damping": "N s/m",
    "coordination.stiffness": "N/m", "coordination.damping": "N s/m",
    "object.mass": "kg", "object.damping": "N s/m", "object.size": "m",
    "proxy.mass": "kg", "proxy.damping": "N s/m", "proxy.radius": "m",
    "device.mass": "kg", "device.damping": "N s/m",
    "network.delay": "s", "network.jitter": "s", "network.rate": "Hz",
    "rates.haptic": "Hz", "rates.host": "Hz", "experiment.duration": "s"}
_NAMES = {"network.rate": "packet rate", "rates.haptic": "haptic rate", "rates.host": "host rate",
          "experiment.duration": "duration"}


def know_schemes(names):
    """Adds schemes that the program was built with."""
    SCHEMES.extend(name for name in names if name not in SCHEMES)


def scheme_label(scheme):
    return scheme.replace("_", " ")


def scheme_colour(scheme):
    return _COLOURS[min(SCHEMES.index(scheme), len(_COLOURS) - 1)]


def scheme_marker(scheme):
    """Schemes differ in shape as well as in colour."""
    return _MARKERS[min(SCHEMES.index(scheme), len(_MARKERS) - 1)]


def user_colour(user):
    """Eight colours; users 9 to 16 have them again."""
    return USER_COLOURS[(user - 1) % len(USER_COLOURS) + 1]


def body_colour(body):
    """Users keep their colour at all sites, whether as device or as proxy."""
    if body.is_user:
        return user_colour(body.user)
    return {"object": "#f0c800", "neighbour": "#56b4e9"}.get(body.role, "#b8b8b8")


def setting_text(key, value):
    """A setting with its unit: "network delay 0.2 s" for network.delay."""
    name = _NAMES.get(key, key.replace(".", " ").replace("_", " "))
    if value is None:
        return f"{name} not set"
    if isinstance(value, bool):
        return f"{name} {str(value).lower()}"
    if isinstance(value, float):
        unit = f" {_SETTINGS[key]}" if key in _SETTINGS else ""
        return f"{name} {value:g}{unit}"
    return f"{name} {value}"


def number_text(value, digits=3):
    """Significant digits without an exponent; a dash for NaN."""
    if not math.isfinite(value):
        return "–"
    if value == 0:
        return "0"
    decimals = digits - 1 - math.floor(math.log10(abs(value)))
    return f"{value:.{min(max(decimals, 0), 9)}f}"


def fixed_text(value, decimals):
    return f"{value:.{decimals}f}" if math.isfinite(value) else "–"


def join_words(words):
    """ "a", "a and b", "a, b and c" """
    return " and ".join(filter(None, [", ".join(words[:-1]), *words[-1:]]))
