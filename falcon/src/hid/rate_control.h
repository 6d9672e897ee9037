#pragma once

#include <optional>

#include "tandem/coordination/types.h"
#include "tandem/falcon/space_mouse_device.h"

namespace tandem {

/// A point and a wrist whose velocities a displacement commands:
///
///   tau v' = v_wanted - v      x' = v
///   v_wanted = speed q_WD (displacement beyond the dead zone)
///
/// and the same with w, turn_speed and the rotation. v_wanted is piecewise constant and the
/// integration is exact, so the times of the calls do not matter. A report every 8 ms makes no jump
/// of the velocity. At a wall of the box the point stops along that axis. Pure and real-time safe.
class RateControl {
 public:
  /// Throws std::invalid_argument with the value's name for settings out of range.
  explicit RateControl(const RateControlSettings& settings = {});

  /// Displacement and rotation of the cap in the user's frame, each part -1 to 1. Non-finite counts
  /// as zero.
  void setDisplacement(const Vec3& displacement_D, const Vec3& rotation_D = Vec3::Zero()) noexcept;
  /// Stops both at once.
  void stop() noexcept;
  /// Advances both by `interval` [s]. Does nothing unless it is finite and above 0.
  void advance(double interval) noexcept;
  /// Puts the point to `p_W`, or to the nearest place in the box. Does nothing unless it is finite.
  void putPoint(const Vec3& p_W) noexcept;

  [[nodiscard]] const PointState& point() const noexcept { return point_; }
  /// Empty with a turn_speed of 0. It starts at the identity.
  [[nodiscard]] std::optional<WristState> wrist() const noexcept {
    if (settings_.turn_speed == 0.0) return std::nullopt;
    return wrist_;
  }
  [[nodiscard]] const RateControlSettings& settings() const noexcept { return settings_; }

 private:
  void keepInBox() noexcept;

  RateControlSettings settings_;
  PointState point_;
  WristState wrist_;
  Vec3 wanted_W_ = Vec3::Zero();       ///< velocity [m/s]
  Vec3 wanted_turn_W_ = Vec3::Zero();  ///< angular velocity [rad/s]
};

}  // namespace tandem
