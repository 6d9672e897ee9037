#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "tandem/coordination/types.h"

#include "site/shorten.h"

namespace tandem {

/// Fastest turn that a peer's states may describe [rad/s].
inline constexpr double kMostPeerRate = 100.0;
/// Fastest motion of a target on its way to where a peer's state jumped [m/s].
inline constexpr double kMostLeadSpeed = 20.0;

/// A body's state with its velocities limited, if `fastest` [m/s] is finite.
[[nodiscard]] inline RigidState limitMotion(RigidState state, double fastest) noexcept {
  if (!std::isfinite(fastest)) return state;
  state.v_W = shortenTo(state.v_W, fastest);
  state.w_W = shortenTo(state.w_W, kMostPeerRate);
  return state;
}

/// Tells whether a peer's state is further from the one before than a body can have moved. Such a
/// state is a reset of the peer's world, or a lie; its receiver moves there smoothly. Plain value.
///
///   |p - p'| <= margin + dt min(fastest, max(|v|, |v'|) + dt acceleration)
class MotionLimit {
 public:
  /// Notes a state that the peer says is of `sent` and that arrived at `arrived` [s]. True if it is
  /// a jump. The peer's own clock counts only as far as the arrivals bear it out. `fastest` is the
  /// greatest speed of a peer [m/s]; if infinite, nothing is a jump.
  [[nodiscard]] bool isJump(const Vec3& p_W, const Vec3& v_W, double sent, double arrived,
                            double fastest) noexcept {
    const std::optional<Last> last = last_;
    last_ = Last{p_W, std::min(v_W.norm(), fastest), sent, arrived};
    if (!last || !std::isfinite(fastest)) return false;
    const double most = std::max(arrived - last->arrived, 0.0) + kLongestJitter;
    const double dt = std::clamp(sent - last->sent, 0.0, most);
    const double speed = std::max(last_->speed, last->speed) + dt * kMostAcceleration;
    return (p_W - last->p_W).norm() > kMargin + dt * std::min(fastest, speed);
  }

  void shiftOrigin(const Vec3& offset_W) noexcept {
    if (last_) last_->p_W += offset_W;
  }

 private:
  static constexpr double kMargin = 0.01;              // [m]
  static constexpr double kMostAcceleration = 2000.0;  // [m/s^2]; impacts included
  static constexpr double kLongestJitter = 0.25;       // [s]

  struct Last {
    Vec3 p_W;
    double speed, sent, arrived;
  };
  std::optional<Last> last_;
};

}  // namespace tandem
