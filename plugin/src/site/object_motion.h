#pragma once

#include <limits>

#include "coordination/src/same_state.h"
#include "site/nearness.h"

namespace tandem {

/// Watches how a shared object moves here, from one packet's moment to the next. Plain value;
/// real-time safe.
class ObjectMotion {
 public:
  explicit ObjectMotion(double radius) noexcept { ball_.radius = radius; }

  /// Notes the object's state at `time` [s]. True if a motion begins: the object stood for a while.
  bool note(const RigidState& state, double time) noexcept {
    if (is_noted_ && isSame(state, state_)) return false;
    const bool begins = is_noted_ && time - changed_at_ > HeldNearness::kCalm;
    if (is_noted_) {
      travelled_ += computeWay(state);
      changed_at_ = time;
    }
    is_noted_ = true;
    state_ = state;
    ball_.p_W = state.p_W;
    ball_.v_W = state.v_W;
    return begins;
  }
  /// Notes the gap to the local user's hand [m].
  void noteGap(double gap, double time) noexcept { nearness_.update(gap, time); }

  [[nodiscard]] const MovingBall& ball() const noexcept { return ball_; }
  /// To the local user's hand.
  [[nodiscard]] Nearness nearness() const noexcept { return nearness_.value(); }
  /// Time of the last state that differed from the one before [s].
  [[nodiscard]] double changedAt() const noexcept { return changed_at_; }
  /// Length of the way so far, of the centre and of a turning edge [m].
  [[nodiscard]] double travelled() const noexcept { return travelled_; }

 private:
  [[nodiscard]] double computeWay(const RigidState& state) const noexcept {
    const double half_turn = (state.q_WB.coeffs() - state_.q_WB.coeffs()).norm();
    return (state.p_W - state_.p_W).norm() + 2.0 * half_turn * ball_.radius;
  }

  RigidState state_;
  MovingBall ball_;
  HeldNearness nearness_;
  bool is_noted_ = false;
  double changed_at_ = -std::numeric_limits<double>::infinity(), travelled_ = 0.0;
};

}  // namespace tandem
