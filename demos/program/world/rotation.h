#pragma once

#include "tandem/coordination/types.h"

namespace tandem::demos {

using Mat3 = Eigen::Matrix3d;

/// The rotation about a vector by its length [rad].
[[nodiscard]] inline Quat makeRotation(const Vec3& vector) {
  const double angle = vector.norm();
  if (angle == 0.0) return Quat::Identity();
  return Quat(Eigen::AngleAxisd(angle, vector / angle));
}

/// The vector of a rotation: axis times angle [rad].
[[nodiscard]] inline Vec3 makeRotationVector(const Mat3& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

}  // namespace tandem::demos
