#pragma once

#include <memory>

#include "tandem/falcon/falcon_device.h"

#include "devices/falcon_rig.h"

namespace tandem::test {

constexpr double kLongest = 20.0;  ///< longest wait for any outcome [s]

/// A busy machine may delay a thread for long; these tests do not measure time.
inline FalconSettings patientSettings() {
  FalconSettings settings;
  settings.reply_time = 0.3;
  settings.quiet_time = 0.3;
  settings.firmware_time = 1.5;
  settings.boot.probe_time = 0.5;
  settings.boot.echo_time = 1.0;
  settings.boot.tries = 4;
  return settings;
}

inline std::unique_ptr<Hand> makeHoldingHand() {
  return makeMinimumJerkHand({{0.0, Vec3::Zero()}}, 1000.0, 10.0);
}

}  // namespace tandem::test
