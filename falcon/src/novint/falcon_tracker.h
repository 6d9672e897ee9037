#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "guard/velocity_estimator.h"
#include "novint/falcon_kinematics.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Positions and velocities of the grip from the counts of its encoders, the velocities by the
/// usual estimator, leg by leg (docs/devices.md). A position that is too far from the last one is
/// believed only if the next one is there, too, and is no velocity. Pure; real-time safe.
class FalconTracker {
 public:
  /// A hand moves by `fastest_hand` [m/s] at most.
  explicit FalconTracker(double fastest_hand) noexcept : fastest_hand_(fastest_hand) {}

  enum class Outcome : std::uint8_t {
    kNone,    ///< no position, or none to be believed: the last one stays
    kMoved,   ///< from the last one
    kPlaced,  ///< for the first time, or after a jump
  };
  Outcome take(const std::array<std::int16_t, 3>& counts, double now) noexcept;

  /// There are no positions now: the next one is the first.
  void forget(double now) noexcept;
  /// The grip counts as standing until it is seen moving.
  void stop() noexcept;

  /// The last one believed.
  [[nodiscard]] const std::optional<FalconPose>& pose() const noexcept { return pose_; }
  [[nodiscard]] const Vec3& velocity() const noexcept { return v_D_; }  ///< [m/s]
  [[nodiscard]] std::uint64_t jumps() const noexcept { return jumps_; }

 private:
  double fastest_hand_;
  FalconKinematics kinematics_;
  AdaptiveWindow count_rates_ = makeUsualVelocityEstimator();
  std::optional<FalconPose> pose_;
  std::optional<Vec3> doubted_D_;  ///< where it jumped to
  Vec3 v_D_ = Vec3::Zero();
  double at_ = 0.0;
  std::uint64_t jumps_ = 0;
};

}  // namespace tandem
#pragma GCC visibility pop
