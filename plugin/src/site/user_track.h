#pragma once

#include <algorithm>

#include "tandem/coordination/types.h"

#include "site/motion_limit.h"

namespace tandem {

/// Position that a remote user counts as having: the latest received state. During a silence this
/// position stands still. Afterwards it moves smoothly to the user, in as much time as the silence
/// took. A jump would throw the bodies that a prescribed proxy touches.
class UserTrack {
 public:
  /// Takes this state over at once.
  void jump(const PointState& user) noexcept {
    latest_ = user;
    missed_for_ = 0.0;
  }

  /// Takes a state received at `time` after a silence of this length [s]; 0 if it was in time.
  /// A state that jumped counts as one after a silence of a second for each metre, at most two
  /// seconds.
  void hear(const PointState& user, double time, double silence, bool jumped = false) noexcept {
    const Vec3 behind_W = at(time, 1.0).p_W - user.p_W;
    const double way = behind_W.norm();
    if (jumped) silence = std::max({silence, std::min(way, 2.0), way / kMostLeadSpeed});
    if (silence > 0.0) {
      missed_W_ = behind_W;
      missed_since_ = time;
      missed_for_ = silence;
    }
    latest_ = user;
  }

  [[nodiscard]] bool isMakingUp(double time) const noexcept {
    return time < missed_since_ + missed_for_;
  }

  void shiftOrigin(const Vec3& offset_W) noexcept { latest_.p_W += offset_W; }

  /// State at `time`, with this share of the last received velocity.
  [[nodiscard]] PointState at(double time, double velocity_share) const noexcept {
    PointState user{latest_.p_W, velocity_share * latest_.v_W};
    if (!isMakingUp(time)) return user;
    user.p_W += (1.0 - std::max(0.0, time - missed_since_) / missed_for_) * missed_W_;
    user.v_W -= missed_W_ / missed_for_;
    return user;
  }

 private:
  PointState latest_;
  Vec3 missed_W_ = Vec3::Zero();
  double missed_since_ = -1.0, missed_for_ = 0.0;
};

}  // namespace tandem
