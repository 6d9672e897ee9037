#pragma once

#include "tandem/coordination/types.h"

namespace tandem::demos {

/// Turns a device's axes (x right, y up, z towards the user) into the world's for the user of
/// `site`, 0 or 1, of a scene with the frame `q_WS`: users stand at the ends of the scene's axis
/// and look at each other, up is up. So user 1 looks along x: away is +x, left is +y, up is +z.
[[nodiscard]] Quat computeUserAxes(const Quat& q_WS, int site);

}  // namespace tandem::demos
