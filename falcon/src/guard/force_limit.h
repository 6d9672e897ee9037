#pragma once

#include "tandem/coordination/types.h"

namespace tandem::falcon_detail {

/// Limits the norm of `f` to `longest` (>= 0) and keeps its direction. Returns zero if `f` is not
/// finite.
[[nodiscard]] inline Vec3 shorten(const Vec3& f, double longest) noexcept {
  if (!f.allFinite()) return Vec3::Zero();
  const double largest = f.cwiseAbs().maxCoeff();
  if (largest == 0.0) return f;
  const Vec3 scaled = f / largest;  // scaled first: the norm of a huge force would overflow
  return largest * scaled.norm() <= longest ? f : Vec3(scaled.normalized() * longest);
}

}  // namespace tandem::falcon_detail
