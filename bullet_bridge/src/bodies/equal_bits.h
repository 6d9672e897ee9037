#pragma once

#include <LinearMath/btTransform.h>

// Bullet compares the fourth number of a vector, too. Nobody sets it: it may be anything.

namespace tandem {

[[nodiscard]] inline bool equalBits(const btVector3& a, const btVector3& b) noexcept {
  return a.x() == b.x() && a.y() == b.y() && a.z() == b.z();
}

[[nodiscard]] inline bool equalBits(const btTransform& a, const btTransform& b) noexcept {
  const btMatrix3x3 &m = a.getBasis(), &n = b.getBasis();
  return equalBits(a.getOrigin(), b.getOrigin()) && equalBits(m[0], n[0]) &&
         equalBits(m[1], n[1]) && equalBits(m[2], n[2]);
}

}  // namespace tandem
