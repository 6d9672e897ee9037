#pragma once

#include <algorithm>

#include "tandem/coordination/types.h"

namespace tandem {

/// The force that follows `last` [N] on the way to `wanted` [N]. It falls at once, and rises by at
/// most `most_rise` [N], towards another direction too. Pure; real-time safe.
///
/// A limit on the fall would render a force after its cause has gone: a hand thrown back by a wall
/// would be pushed on, and get energy that nobody put in.
[[nodiscard]] inline Vec3 riseTowards(const Vec3& wanted, const Vec3& last,
                                      double most_rise) noexcept {
  const double square = last.squaredNorm();
  // The part of `last` that `wanted` keeps: its nearest point between zero and `last`.
  const Vec3 kept =
      square > 0.0 ? Vec3(std::clamp(wanted.dot(last) / square, 0.0, 1.0) * last) : last;
  const Vec3 rise = wanted - kept;
  const double norm = rise.norm();
  return norm <= most_rise ? wanted : Vec3(kept + most_rise / norm * rise);
}

}  // namespace tandem
