#pragma once

#include <cmath>

#include "geometry/plain_vec.h"
#include "island/island.h"

namespace tandem {

/// The law of an IslandGrip, for the forces of an integration step and those of an instant.
class GripLaw {
 public:
  /// Force of the hand on the place, torque on the body, and load on the place, in W.
  struct Pull {
    PlainVec f, t, load;
    bool is_limited = false;
  };

  GripLaw() = default;
  explicit GripLaw(const IslandGrip& hold) noexcept
      : place_(hold.p_FG),
        offset_(hold.offset_W),
        lift_(hold.lift_W),
        turning_(hold.w_W),
        load_(hold.load_W),
        gains_(hold.gains),
        max_force_(hold.max_force),
        max_torque_(hold.max_torque),
        share_(hold.share) {}

  [[nodiscard]] const PlainVec& place() const noexcept { return place_; }
  [[nodiscard]] double damping() const noexcept { return gains_.linear.damping; }
  [[nodiscard]] double turnDamping() const noexcept { return gains_.angular.damping; }
  /// An integration step cannot follow every damper.
  void limitDamping(double damping, double turn_damping) noexcept {
    gains_.linear.damping = damping;
    gains_.angular.damping = turn_damping;
  }

  /// `way` and `rate` lead from the place to the hand, `turn` to the wanted orientation. `w` is the
  /// body's angular velocity.
  [[nodiscard]] Pull compute(const PlainVec& way, const PlainVec& rate, const PlainVec& turn,
                             const PlainVec& w) const noexcept {
    Pull pull;
    pull.f = gains_.linear.stiffness * (way + offset_) + gains_.linear.damping * rate + lift_;
    pull.is_limited = limit(pull.f, max_force_);
    pull.t = gains_.angular.stiffness * turn + gains_.angular.damping * (turning_ - w);
    limit(pull.t, max_torque_);
    pull.f = share_ * pull.f;
    pull.t = share_ * pull.t;
    pull.load = share_ * load_;
    return pull;
  }

 private:
  /// True if it had to be shortened.
  static bool limit(PlainVec& pull, double most) noexcept {
    const double square = dot(pull, pull);
    if (!(square > most * most)) return false;
    pull = (most / std::sqrt(square)) * pull;
    return true;
  }

  PlainVec place_, offset_, lift_, turning_, load_;
  CouplerSettings gains_;
  double max_force_ = 0.0, max_torque_ = 0.0, share_ = 1.0;
};

}  // namespace tandem
