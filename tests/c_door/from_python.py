#!/usr/bin/env python3
"""Calls the C door from Python, as a binding of another language would: a cube of a world of
Tandem's falls for a second, refusals arrive with their words, and a device calls back.

Usage: from_python.py LIBRARY
"""

import ctypes
import math
import sys
from ctypes import POINTER, byref, c_char_p, c_double, c_int, c_size_t, c_uint32, c_void_p


class State(ctypes.Structure):
    _fields_ = [("position", c_double * 3), ("orientation", c_double * 4),
                ("velocity", c_double * 3), ("angular_velocity", c_double * 3)]


class BodySettings(ctypes.Structure):
    _fields_ = [("internal", c_int), ("shape", c_int), ("size", c_double * 3),
                ("points", POINTER(c_double)), ("point_count", c_size_t), ("mass", c_double),
                ("inertia", c_double * 3), ("friction", c_double), ("restitution", c_double),
                ("start", State)]


READ = ctypes.CFUNCTYPE(c_int, c_void_p, c_double, POINTER(c_double), POINTER(c_double))
WRITE = ctypes.CFUNCTYPE(None, c_void_p, POINTER(c_double))


class DeviceFunctions(ctypes.Structure):
    _fields_ = [("read", READ), ("write", WRITE), ("user", c_void_p)]


class DeviceLimits(ctypes.Structure):
    _fields_ = [("max_force", c_double), ("max_slew", c_double)]


class SiteSettings(ctypes.Structure):
    """Only its size matters here: the settings go back as they came."""
    _fields_ = [("bytes", c_double * 64)]


def check(library, result, expected="TANDEM_OK"):
    name = library.tandem_result_name(result).decode()
    assert name == expected, f"{name}: {library.tandem_last_error().decode()}"


def main(arguments):
    library = ctypes.CDLL(arguments[0])
    library.tandem_last_error.restype = c_char_p
    library.tandem_result_name.restype = c_char_p
    library.tandem_version.restype = c_char_p
    library.tandem_default_body_settings.restype = BodySettings
    library.tandem_default_site_settings.restype = SiteSettings
    library.tandem_world_step.argtypes = [c_void_p, c_double, c_int, c_double]
    library.tandem_device_create.argtypes = [DeviceFunctions, DeviceLimits, POINTER(c_void_p)]
    for name in ("world", "device", "site"):
        getattr(library, f"tandem_{name}_destroy").argtypes = [c_void_p]

    world, device, site = c_void_p(), c_void_p(), c_void_p()
    check(library, library.tandem_world_create(byref(world)))
    check(library, library.tandem_world_set_gravity(world, (c_double * 3)(0, 0, -9.81)))
    settings, body = library.tandem_default_body_settings(), c_uint32()
    check(library, library.tandem_world_add_body(world, byref(settings), byref(body)))

    forces = []

    def read(_user, _now, position, velocity):
        for i in range(3):
            position[i], velocity[i] = 10.0, 0.0
        return 1

    def write(_user, force):
        forces.append(force[0])

    functions = DeviceFunctions(READ(read), WRITE(write), None)
    check(library, library.tandem_device_create(
        functions, DeviceLimits(math.inf, math.inf), byref(device)))
    defaults = library.tandem_default_site_settings()
    check(library, library.tandem_site_create(byref(defaults), world, device, byref(site)))

    for _ in range(60):
        check(library, library.tandem_world_step(world, 1 / 60, 0, 0))
    state = State()
    check(library, library.tandem_world_get_states(world, c_size_t(1), byref(body), byref(state)))
    # Semi-implicit Euler of 60 steps: g T^2 / 2 (1 + 1/60).
    assert abs(state.position[2] + 9.81 / 2 * (1 + 1 / 60)) < 1e-4, state.position[2]
    assert len(forces) == 1000 and set(forces) == {0.0}, len(forces)

    settings.mass = -1.0
    check(library, library.tandem_world_add_body(world, byref(settings), byref(body)),
          "TANDEM_INVALID_ARGUMENT")
    assert b"mass = -1" in library.tandem_last_error(), library.tandem_last_error()
    check(library, library.tandem_world_destroy(world), "TANDEM_IN_USE")
    check(library, library.tandem_site_destroy(site))
    check(library, library.tandem_device_destroy(device))
    check(library, library.tandem_world_destroy(world))
    check(library, library.tandem_world_destroy(world), "TANDEM_INVALID_ARGUMENT")
    print(f"tandem {library.tandem_version().decode()}: a cube fell {-state.position[2]:.4f} m")


if __name__ == "__main__":
    main(sys.argv[1:])
