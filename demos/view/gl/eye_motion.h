#pragma once

#include "gl/projection.h"
#include "scene/draw_list.h"

namespace tandem::view {

/// Within these an eye stays, whatever a user does.
inline constexpr double kNearestEye = 0.02, kFarthestEye = 20.0;  ///< from its target [m]
inline constexpr double kSteepestEye = 1.5;      ///< up and down; short of the pole [rad]
inline constexpr double kFarthestTarget = 50.0;  ///< along each axis of W [m]

/// The nearest eye within the limits, with its azimuth between -pi and pi. Numbers that are not
/// finite become those of a new Eye.
[[nodiscard]] Eye limitEye(const Eye& eye);

/// Turns the eye about its target [rad]. Angles that are not finite change nothing.
[[nodiscard]] Eye orbitEye(const Eye& eye, double azimuth, double elevation);

/// Moves the eye with its target so that the target follows a pointer, to the right and down
/// [pixel]. An empty picture or numbers that are not finite change nothing.
[[nodiscard]] Eye panEye(const Eye& eye, PictureSize size, double right, double down);

/// Multiplies the distance; below one comes closer. A factor that is not positive and finite
/// changes nothing.
[[nodiscard]] Eye zoomEye(const Eye& eye, double factor);

}  // namespace tandem::view
