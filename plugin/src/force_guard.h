#pragma once

#include "tandem/coordination/types.h"

namespace tandem {

/// The last hand on the force before the device: never beyond the device's limit (direction kept),
/// never not finite, and after a fault down to zero by a bounded slew instead of at once.
class ForceGuard {
 public:
  /// `max_force` [N], may be infinite; `fade_per_tick` [N].
  ForceGuard(double max_force, double fade_per_tick) noexcept
      : max_force_(max_force), fade_per_tick_(fade_per_tick) {}

  [[nodiscard]] Vec3 limit(const Vec3& wanted_W, bool fault) noexcept {
    const double last = last_W_.norm();
    if (fault || !wanted_W.allFinite()) {
      last_W_ *= last > fade_per_tick_ ? (last - fade_per_tick_) / last : 0.0;
      return last_W_;
    }
    const double norm = wanted_W.norm();
    last_W_ = norm > max_force_ ? Vec3(wanted_W * (max_force_ / norm)) : wanted_W;
    return last_W_;
  }

 private:
  double max_force_, fade_per_tick_;
  Vec3 last_W_ = Vec3::Zero();
};

}  // namespace tandem
