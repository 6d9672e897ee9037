#pragma once

#include <algorithm>

#include "tandem/coordination/types.h"

#include "site/motion_limit.h"

namespace tandem {

// clang-format off
/// Moves a coupler's target smoothly from our copy of an object to a peer's, when the peer comes
/// back. Copies drift apart while a link is cut. A spring between them that regained its stiffness
/// would be stretched, with energy from nowhere. With a detour it is not: copies meet at walking
/// pace.
///
///   speed = min(max(0.25 m/s, d0 / 2 s), d / 0.1 s), at most kMostLeadSpeed
///
/// d0 is the distance at the start and d the present one. The rotation follows the same law, with
/// 2.5 rad/s. Plain value without a clock.
// clang-format on
class Detour {
 public:
  void start(const RigidState& ours, const RigidState& theirs) noexcept {
    offset_W_ = ours.p_W - theirs.p_W;
    const Eigen::AngleAxisd turn((ours.q_WB * theirs.q_WB.conjugate()).normalized());
    angle_ = turn.angle();  // at most pi
    axis_W_ = turn.axis();
    top_speed_ = std::clamp(offset_W_.norm() / kLongest, kSpeed, kMostLeadSpeed);
    top_rate_ = std::max(kRate, angle_ / kLongest);
    settle();
  }

  /// Moves on by `dt` [s].
  void advance(double dt) noexcept {
    if (isOver()) return;
    offset_W_ += dt * velocity();
    angle_ -= dt * rate();
    settle();
  }

  [[nodiscard]] bool isOver() const noexcept { return angle_ == 0.0 && offset_W_ == Vec3::Zero(); }
  /// Target during the detour to a copy at `theirs`.
  [[nodiscard]] RigidState apply(RigidState theirs) const noexcept {
    if (isOver()) return theirs;
    theirs.p_W += offset_W_;
    theirs.v_W += velocity();
    theirs.q_WB = (Quat(Eigen::AngleAxisd(angle_, axis_W_)) * theirs.q_WB).normalized();
    theirs.w_W -= rate() * axis_W_;
    return theirs;
  }

 private:
  static constexpr double kSpeed = 0.25, kRate = 2.5;  // [m/s], [rad/s]
  static constexpr double kLongest = 2.0;              // [s]
  static constexpr double kDecay = 0.1;                // [s]
  static constexpr double kThere = 1e-6;               // [m], [rad]

  [[nodiscard]] Vec3 velocity() const noexcept {
    const double distance = offset_W_.norm();
    if (distance == 0.0) return Vec3::Zero();
    return offset_W_ * (-std::min(top_speed_ / distance, 1.0 / kDecay));
  }
  [[nodiscard]] double rate() const noexcept { return std::min(top_rate_, angle_ / kDecay); }
  void settle() noexcept {
    if (offset_W_.norm() < kThere) offset_W_.setZero();
    if (angle_ < kThere) angle_ = 0.0;
  }

  Vec3 offset_W_ = Vec3::Zero(), axis_W_ = Vec3::UnitX();
  double angle_ = 0.0;
  double top_speed_ = kSpeed, top_rate_ = kRate;
};

}  // namespace tandem
