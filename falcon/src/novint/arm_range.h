#pragma once

#include "novint/falcon_kinematics.h"

namespace tandem::falcon_detail {

/// Where a Falcon's arms can be: they turn from -0.6 to 1.45 rad where the grip goes. Encoders that
/// are a whole turn off would give a position that looks as good.
[[nodiscard]] inline bool areInRange(const FalconAngles& angles) noexcept {
  return angles.minCoeff() >= -1.2 && angles.maxCoeff() <= 2.2;
}

}  // namespace tandem::falcon_detail
