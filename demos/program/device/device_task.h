#pragma once

#include <optional>
#include <string>

#include "device/device_options.h"
#include "device/exchange.h"

namespace tandem::demos {

/// Options of `tandem device` and its commands, as written.
struct DeviceTask {
  DeviceOptions device;
  std::optional<double> duration;       ///< [s]
  double patience = 120.0;              ///< longest wait until ready [s]
  std::string file;                     ///< file of `record`
  std::optional<std::string> scenario;  ///< scenario of `feel`
  bool json = false;
  bool quiet = false;
};

/// Commands of `tandem device`. Each runs to its end, or until `pause` returns true. They throw
/// UsageError or std::invalid_argument (status 2), or tandem::Error with the remedy (status 1).
void listDevices(const DeviceTask& task);
void showDevice(const DeviceTask& task, const Pause& pause);
void homeDevice(const DeviceTask& task, const Pause& pause);
/// Returns false if an emulated device had a wrong force or motion.
[[nodiscard]] bool checkDevice(const DeviceTask& task, const Pause& pause);
void measureLatency(const DeviceTask& task, const Pause& pause);
void recordDevice(const DeviceTask& task, const Pause& pause);

/// The placement of these commands: user 1's in a scene whose axis is x.
[[nodiscard]] Placement placeAlone();

}  // namespace tandem::demos
