#pragma once

#include "device/device_command.h"

namespace CLI {
class App;
}

namespace tandem::demos {

/// --device, --firmware, --motors-per-torque, --max-force, --scale, --offset, --clutch.
void addDeviceOptions(CLI::App& app, DeviceOptions& options);

/// `tandem device` with its commands.
CLI::App* addDeviceCommand(CLI::App& app, DeviceCommand& command);

/// Runs what was parsed. False: a check failed. Throws UsageError, std::invalid_argument or
/// tandem::Error, one line. Signals to end, a closed terminal and a closed pipe take the force
/// away.
[[nodiscard]] bool runDeviceCommand(const CLI::App& device, const DeviceCommand& command);

}  // namespace tandem::demos
