#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>

#include "tandem/falcon/guarded_device.h"

#include "devices/told_device.h"

namespace tandem::test {

inline constexpr double kPeriod = 1e-3;  // [s]
inline constexpr double kInf = std::numeric_limits<double>::infinity();

/// A guard over a scripted device, run tick by tick.
class GuardRig {
 public:
  explicit GuardRig(const GuardSettings& settings = {}, const DeviceCapabilities& device = {})
      : script{device},
        guard(std::make_unique<GuardedDevice>(std::make_unique<ToldDevice>(script), settings)) {}

  /// Reads one period later and writes; returns the device's force.
  Vec3 tick(const Vec3& wanted) {
    now += kPeriod;
    (void)guard->read(now);
    guard->write(wanted);
    return script.force;
  }
  void tickFor(double duration, const Vec3& wanted) {
    const int ticks = static_cast<int>(std::lround(duration / kPeriod));
    for (int i = 0; i < ticks; ++i) (void)tick(wanted);
  }
  /// Ticks until the ramp is over.
  void warmUp(const Vec3& wanted) { tickFor(0.6, wanted); }
  [[nodiscard]] std::uint64_t cuts(GuardCut reason) const {
    return guard->status().cuts[static_cast<std::size_t>(reason)];
  }

  DeviceScript script;
  std::unique_ptr<GuardedDevice> guard;
  double now = 10.0;  // [s]
};

inline const Vec3 kPush(0.0, 3.0, -4.0);  // 5 N

}  // namespace tandem::test
