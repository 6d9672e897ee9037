#pragma once

#include "tandem/coordination/types.h"

namespace tandem::demos {

/// The rotation about a vector by its length [rad].
[[nodiscard]] inline Quat makeRotation(const Vec3& vector) {
  const double angle = vector.norm();
  if (angle == 0.0) return Quat::Identity();
  return Quat(Eigen::AngleAxisd(angle, vector / angle));
}

}  // namespace tandem::demos
