#pragma once

#include "tandem/coordination/types.h"

namespace tandem::falcon_detail {

/// `f` with its direction kept, no longer than `longest` (>= 0); zero if it is not finite.
[[nodiscard]] inline Vec3 shorten(const Vec3& f, double longest) noexcept {
  if (!f.allFinite()) return Vec3::Zero();
  const double largest = f.cwiseAbs().maxCoeff();
  if (largest == 0.0) return f;
  const Vec3 scaled = f / largest;  // so that the norm of a huge force does not overflow
  return largest * scaled.norm() <= longest ? f : Vec3(scaled.normalized() * longest);
}

}  // namespace tandem::falcon_detail
