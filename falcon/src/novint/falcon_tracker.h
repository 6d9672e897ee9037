#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "guard/velocity_estimator.h"
#include "novint/falcon_kinematics.h"

namespace tandem {

/// Positions and velocities of the grip from its encoder counts. The velocities come from the
/// default estimator, leg by leg (docs/devices.md). A position too far from the last one is
/// accepted only if the next one confirms it, and gives no velocity. Pure; real-time safe.
class FalconTracker {
 public:
  /// `fastest_hand` is the largest speed of a hand [m/s].
  explicit FalconTracker(double fastest_hand) noexcept : fastest_hand_(fastest_hand) {}

  enum class Outcome : std::uint8_t {
    kNone,    ///< no acceptable position; the last one stays
    kMoved,   ///< moved from the last position
    kPlaced,  ///< first position, or first one after a jump
  };
  Outcome take(const std::array<std::int16_t, 3>& counts, double now) noexcept;

  /// Forgets the position: the next one is the first.
  void forget(double now) noexcept;
  /// Sets the velocity to zero until the grip is seen to move.
  void stop() noexcept;

  /// Last accepted pose.
  [[nodiscard]] const std::optional<FalconPose>& pose() const noexcept { return pose_; }
  [[nodiscard]] const Vec3& velocity() const noexcept { return v_D_; }  ///< [m/s]
  /// Time of the last accepted pose [s].
  [[nodiscard]] double seenAt() const noexcept { return at_; }
  [[nodiscard]] std::uint64_t jumps() const noexcept { return jumps_; }

 private:
  double fastest_hand_;
  FalconKinematics kinematics_;
  AdaptiveWindow count_rates_ = makeUsualVelocityEstimator();
  std::optional<FalconPose> pose_;
  std::optional<Vec3> doubted_D_;  ///< unconfirmed position after a jump
  Vec3 v_D_ = Vec3::Zero();
  double at_ = 0.0;
  std::uint64_t jumps_ = 0;
};

}  // namespace tandem
