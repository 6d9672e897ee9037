#pragma once

#include <algorithm>
#include <cstdint>

#include "tandem/coordination/types.h"

#include "coordination/src/force_rise.h"
#include "site/shorten.h"

namespace tandem {

/// Limits the force to the device's abilities: its norm, with the direction kept, and its rise from
/// tick to tick; it may fall at once (riseTowards). After a fault it fades to zero at a bounded
/// rate.
class ForceGuard {
 public:
  /// `max_force` [N] and `rise_per_tick` [N] may be infinite. `fade_per_tick` [N] is limited to
  /// `rise_per_tick`.
  ForceGuard(double max_force, double rise_per_tick, double fade_per_tick) noexcept
      : max_force_(max_force),
        rise_per_tick_(rise_per_tick),
        fade_per_tick_(std::min(fade_per_tick, rise_per_tick)) {}

  /// Shortens a force to the device's limit.
  [[nodiscard]] Vec3 clamp(const Vec3& wanted_W) noexcept {
    if (!(wanted_W.norm() > max_force_)) return wanted_W;
    ++clamped_;
    return shortenTo(wanted_W, max_force_);
  }

  /// The force of this tick: from the last tick's force to `allowed_W`, as fast as allowed.
  [[nodiscard]] Vec3 follow(const Vec3& allowed_W, bool fault) noexcept {
    if (fault || !allowed_W.allFinite()) return shortenTo(last_W_, last_W_.norm() - fade_per_tick_);
    if (allowed_W == last_W_) return last_W_;
    const Vec3 force_W = riseTowards(allowed_W, last_W_, rise_per_tick_);
    if (force_W != allowed_W) ++slewed_;
    return force_W;
  }

  /// Notes the force that is rendered in the end. The next tick starts from it.
  void note(const Vec3& rendered_W) noexcept { last_W_ = rendered_W; }

  /// Number of ticks in which the force exceeded the device's limit.
  [[nodiscard]] std::uint64_t clampedCount() const noexcept { return clamped_; }
  /// Number of ticks in which the force was limited in its rise.
  [[nodiscard]] std::uint64_t slewedCount() const noexcept { return slewed_; }

 private:
  double max_force_, rise_per_tick_, fade_per_tick_;
  Vec3 last_W_ = Vec3::Zero();
  std::uint64_t clamped_ = 0, slewed_ = 0;
};

}  // namespace tandem
