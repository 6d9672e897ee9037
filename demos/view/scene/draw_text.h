#pragma once

#include <string>

#include "scene/draw_list.h"

namespace tandem::view {

/// Writes a draw list as text, one line for each solid and then one for each line:
///
///     cube: 12 triangles at 0.000000 0.000000 0.020000 turned 1.000000 0.000000 0.000000 0.000000
///     colour #5c8cb8 ghost
///     line from 0.000000 0.000000 0.000000 to 0.000000 0.000000 0.010000 colour #ffff00 width 1.0
///
/// (the first two are one line). Positions [m] and quaternions (w x y z) are rounded to 1e-6. Equal
/// rotations give equal text: the first part of a quaternion that is not zero is positive. Zero has
/// no sign.
[[nodiscard]] std::string writeDrawList(const DrawList& list);

}  // namespace tandem::view
