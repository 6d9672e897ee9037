#pragma once

#include "novint/falcon_kinematics.h"

namespace tandem::falcon_detail {

/// True if the arms are at angles that they can reach. In the workspace they turn from -0.6 to 1.45
/// rad. Without this check, encoders that are off by a whole turn would give a plausible position.
[[nodiscard]] inline bool areInRange(const FalconAngles& angles) noexcept {
  return angles.minCoeff() >= -1.2 && angles.maxCoeff() <= 2.2;
}

}  // namespace tandem::falcon_detail
