#pragma once

#include "tandem/coordination/types.h"
#include "tandem/falcon/falcon_settings.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Force that must go is gone after so much time of frames, however slowly else it may change [s].
constexpr double kLongestForceFade = 0.03;

/// Makes of the force that is asked for the one that is sent. Pure; real-time safe.
class FalconForceGate {
 public:
  explicit FalconForceGate(const FalconForceLimits& limits) noexcept : limits_(limits) {}

  /// `age`: since it was asked for [s]; `is_open`: whether there may be force at all. Anything not
  /// finite asks for none. Never changes by more than the slew limit, on the way to zero neither:
  /// that takes 4 ms from 8 N. Force that is not renewed, not finite or not allowed any more goes
  /// within 30 ms even if the slew limit is lower. A call counts for 1 ms at most.
  Vec3 advance(const Vec3& wanted, double age, bool is_open, double now) noexcept;

  /// The ramp begins anew, after a position that jumped.
  void restart(double now) noexcept { opened_at_ = now; }
  [[nodiscard]] const Vec3& force() const noexcept { return force_; }
  /// For a line that is gone: nothing is sent.
  void clear() noexcept;

 private:
  [[nodiscard]] Vec3 limit(const Vec3& wanted, double age, double now) const noexcept;

  FalconForceLimits limits_;
  Vec3 force_ = Vec3::Zero();
  bool was_open_ = false;
  double opened_at_ = 0.0, last_ = 0.0;
};

}  // namespace tandem
#pragma GCC visibility pop
