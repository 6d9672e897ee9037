#pragma once

#include <cmath>

#include "tandem/coordination/types.h"

namespace tandem {

/// The rotation vector in W that rotates `from` to `to` the shorter way [rad]. Its length is the
/// angle, at most pi.
[[nodiscard]] inline Vec3 computeRotationVector(const Quat& from, const Quat& to) noexcept {
  Quat turn = to * from.conjugate();
  if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();
  const double sine = turn.vec().norm();
  // atan2 is exact near 0, where acos is not.
  const double angle = 2.0 * std::atan2(sine, turn.w());
  const double scale = sine > 1e-12 ? angle / sine : 2.0;
  return scale * turn.vec();
}

/// The rotation about `vector` by its length [rad]; inverse of computeRotationVector().
[[nodiscard]] inline Quat makeRotation(const Vec3& vector) noexcept {
  const double half = 0.5 * vector.norm();
  const double scale = half > 1e-9 ? 0.5 * std::sin(half) / half : 0.5;
  Quat turn;
  turn.vec() = scale * vector;
  turn.w() = std::cos(half);
  return turn;
}

}  // namespace tandem
