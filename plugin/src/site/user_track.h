#pragma once

#include <algorithm>

#include "tandem/coordination/types.h"

namespace tandem {

/// Where a remote user counts as being: the state heard last. After a silence in which that stood,
/// a body that *is* it would jump, and throw whom it touches; it goes to where the user is in as
/// long as the silence was.
class UserTrack {
 public:
  /// From now on exactly there.
  void jump(const PointState& user) noexcept {
    latest_ = user;
    missed_for_ = 0.0;
  }

  /// A state came in at `time` after a silence of so long [s]; 0: in time.
  void hear(const PointState& user, double time, double silence) noexcept {
    if (silence > 0.0) {
      missed_W_ = at(time, 1.0).p_W - user.p_W;
      missed_since_ = time;
      missed_for_ = silence;
    }
    latest_ = user;
  }

  [[nodiscard]] bool isMakingUp(double time) const noexcept {
    return time < missed_since_ + missed_for_;
  }

  /// `velocity_share`: of the velocity heard last.
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
