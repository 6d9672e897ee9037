#pragma once

#include <algorithm>

#include "tandem/coordination/types.h"

namespace tandem {

/// The way on which a target is led to where a peer has its copy, from where ours is, when the peer
/// comes back. While a link is cut copies go their own ways; a spring between them that gets its
/// gain back would be stretched already, and the energy in it would come from nowhere. Led along,
/// it is not: copies meet at a walking pace.
///
///   speed = min(max(0.25 m/s, d / 2 s), d / 0.1 s),   the same for the turn with 2.5 rad/s
///
/// with the distance d at the start in the first, now in the second. Plain value without a clock.
class Detour {
 public:
  void start(const RigidState& ours, const RigidState& theirs) noexcept {
    offset_W_ = ours.p_W - theirs.p_W;
    const Eigen::AngleAxisd turn((ours.q_WB * theirs.q_WB.conjugate()).normalized());
    angle_ = turn.angle();  // at most pi
    axis_W_ = turn.axis();
    top_speed_ = std::max(kSpeed, offset_W_.norm() / kLongest);
    top_rate_ = std::max(kRate, angle_ / kLongest);
    settle();
  }

  /// By `dt` [s].
  void advance(double dt) noexcept {
    if (isOver()) return;
    offset_W_ += dt * velocity();
    angle_ -= dt * rate();
    settle();
  }

  [[nodiscard]] bool isOver() const noexcept { return angle_ == 0.0 && offset_W_ == Vec3::Zero(); }
  /// Where the target is meanwhile, for a copy that is `theirs`.
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
