#pragma once

#include <algorithm>
#include <cstdint>

#include "tandem/coordination/types.h"

namespace tandem {

/// Limits the force last, before the device. The force stays finite and within the device's limit,
/// with its direction kept. It changes at a bounded rate, and fades to zero at a bounded rate after
/// a fault.
class ForceGuard {
 public:
  /// `max_force` [N] and `change_per_tick` [N] may be infinite. `fade_per_tick` [N] is limited to
  /// `change_per_tick`.
  ForceGuard(double max_force, double change_per_tick, double fade_per_tick) noexcept
      : max_force_(max_force),
        change_per_tick_(change_per_tick),
        fade_per_tick_(std::min(fade_per_tick, change_per_tick)) {}

  /// Shortens a force to the device's limit.
  [[nodiscard]] Vec3 clamp(const Vec3& wanted_W) noexcept {
    if (!(wanted_W.norm() > max_force_)) return wanted_W;
    ++clamped_;
    return shorten(wanted_W, max_force_);
  }

  /// Moves from the last tick's force towards `allowed_W`, as fast as allowed.
  [[nodiscard]] Vec3 follow(const Vec3& allowed_W, bool fault) noexcept {
    if (fault || !allowed_W.allFinite()) {
      last_W_ = shorten(last_W_, last_W_.norm() - fade_per_tick_);
      return last_W_;
    }
    if (allowed_W == last_W_) return last_W_;
    const Vec3 wanted_change_W = allowed_W - last_W_;
    if (wanted_change_W.norm() > change_per_tick_) {
      ++slewed_;
      last_W_ += shorten(wanted_change_W, change_per_tick_);
    } else {
      last_W_ = allowed_W;
    }
    return last_W_;
  }

  /// Number of ticks in which the force exceeded the device's limit.
  [[nodiscard]] std::uint64_t clampedCount() const noexcept { return clamped_; }
  /// Number of ticks in which the force was limited in its change.
  [[nodiscard]] std::uint64_t slewedCount() const noexcept { return slewed_; }

 private:
  static Vec3 shorten(const Vec3& v, double longest) noexcept {
    const double norm = v.norm();
    if (norm <= longest) return v;
    return longest > 0.0 ? Vec3(v * (longest / norm)) : Vec3(Vec3::Zero());
  }

  double max_force_, change_per_tick_, fade_per_tick_;
  Vec3 last_W_ = Vec3::Zero();
  std::uint64_t clamped_ = 0, slewed_ = 0;
};

}  // namespace tandem
