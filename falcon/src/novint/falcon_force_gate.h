#pragma once

#include "tandem/coordination/types.h"
#include "tandem/falcon/falcon_settings.h"

namespace tandem {

/// Longest time from max_force to zero when the force must end, even for a lower slew limit [s].
constexpr double kLongestForceFade = 0.03;

/// Turns the requested force into the force that is sent. Pure; real-time safe.
class FalconForceGate {
 public:
  explicit FalconForceGate(const FalconForceLimits& limits) noexcept : limits_(limits) {}

  /// `age` is the time since the request [s]; `is_open` tells whether force is allowed at all. A
  /// non-finite request counts as zero. The rise never exceeds the slew limit, and a request that
  /// falls is followed at once. A force that is not renewed, not finite or no longer allowed fades
  /// at the slew limit, 4 ms from 8 N, and within 30 ms even if that limit is lower. A call counts
  /// for at most 1 ms.
  Vec3 advance(const Vec3& wanted, double age, bool is_open, double now) noexcept;

  /// Only this share (0 to 1) of the force was sent: the next one rises from there.
  void lower(double share) noexcept { force_ *= share; }
  /// Restarts the ramp after a position that jumped.
  void restart(double now) noexcept { opened_at_ = now; }
  [[nodiscard]] const Vec3& force() const noexcept { return force_; }
  /// Forgets the force, because the line is gone.
  void clear() noexcept;

 private:
  [[nodiscard]] double computeShare(double age, double now) const noexcept;

  FalconForceLimits limits_;
  Vec3 force_ = Vec3::Zero();
  bool was_open_ = false;
  double opened_at_ = 0.0, last_ = 0.0;
};

}  // namespace tandem
