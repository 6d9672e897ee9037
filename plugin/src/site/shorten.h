#pragma once

#include "tandem/coordination/types.h"

namespace tandem {

/// Shortens a vector to `longest`; shorter ones stay the same to the bit. Zero if `longest` is not
/// above zero. Pure; real-time safe.
[[nodiscard]] inline Vec3 shortenTo(const Vec3& v, double longest) noexcept {
  const double norm = v.norm();
  if (norm <= longest) return v;
  return longest > 0.0 ? Vec3(longest / norm * v) : Vec3(Vec3::Zero());
}

}  // namespace tandem
