#pragma once

#include "tandem/coordination/types.h"

namespace tandem::demos {

/// Rotation from a device's axes (x right, y up, z towards the user) to the world's. `site` counts
/// from 0, `q_WS` is the scene's frame. Users stand at the ends of the scene's axis, the first,
/// third and so on at -x, and look at each other; up is up. So user 1 looks along x: away is +x,
/// left is +y, up is +z.
[[nodiscard]] Quat computeUserAxes(const Quat& q_WS, int site);

}  // namespace tandem::demos
