#pragma once

#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

/// How the displacement of a cap that springs back becomes the motion of a point.
struct RateControlSettings {
  double speed = 0.15;      ///< at full displacement along an axis [m/s], > 0
  double dead_zone = 0.05;  ///< part of the full displacement that is none, 0 to below 1
  double smoothing = 0.03;  ///< time constant of the velocity [s], > 0; more is smoother and later
  Vec3 start_W = Vec3::Zero();            ///< where the point begins, the middle of its box [m]
  Vec3 workspace = Vec3::Constant(0.15);  ///< half extents of the box that it stays in [m], > 0
  Quat q_WD = Quat(1.0, 0.0, 0.0, 0.0);   ///< from the user's frame (x right, y up, z back) to W
};

/// A point whose velocity a hand commands:
///
///   tau v' = v_wanted - v      x' = v      v_wanted = speed q_WD (displacement beyond the dead
///   zone)
///
/// integrated exactly while v_wanted stands, so that it does not matter when it is asked, and a
/// report every 8 ms makes no jump of the velocity. At a wall of the box the point stops along that
/// axis. Pure and real-time safe.
class RateControl {
 public:
  /// Throws std::invalid_argument, naming the value, for settings out of range.
  explicit RateControl(const RateControlSettings& settings = {});

  /// Displacement of the cap in the user's frame, each part -1 to 1. Not finite: none.
  void setDisplacement(const Vec3& displacement_D) noexcept;
  /// Stands still at once.
  void stop() noexcept;
  /// Moves for `interval` [s]; not above 0 or not finite: does not.
  void advance(double interval) noexcept;

  [[nodiscard]] const PointState& point() const noexcept { return point_; }
  [[nodiscard]] const RateControlSettings& settings() const noexcept { return settings_; }

 private:
  RateControlSettings settings_;
  PointState point_;
  Vec3 wanted_W_ = Vec3::Zero();  ///< velocity [m/s]
};

}  // namespace tandem
#pragma GCC visibility pop
