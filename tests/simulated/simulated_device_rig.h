#pragma once

#include <limits>

#include "tandem/falcon/simulated_device.h"

namespace tandem::test {

inline constexpr double kEps = std::numeric_limits<double>::epsilon();
inline constexpr double kPeriod = 1e-3;  ///< haptic period [s]

inline SimulatedDevice makeDevice(const SimulatedDeviceSettings& settings, const Vec3& hand_force) {
  return {settings, makeConstantHand(hand_force)};
}

/// Reads at every haptic period from 0 to `ticks`. Gives the last sample.
inline DeviceSample readTicks(HapticDevice& device, int ticks) {
  DeviceSample sample;
  for (int i = 0; i <= ticks; ++i) sample = device.read(i * kPeriod);
  return sample;
}

}  // namespace tandem::test
