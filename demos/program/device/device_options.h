#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tandem/falcon/falcon_settings.h"

namespace tandem::demos {

class Arguments;

/// Options of all commands with a device, as written.
struct DeviceOptions {
  std::string device;                   ///< a DeviceSpec; empty: the first one plugged in
  std::optional<std::string> firmware;  ///< file of a Falcon's firmware image
  std::optional<std::string> clutch;    ///< see device_switch.h; empty: no clutch
  std::optional<std::string> grip;      ///< the same for holding things
  double motors_per_torque = kUsualMotorsPerTorque;  ///< [1/(N m)]
  double max_force = 8.0;                            ///< [N]
  double scale = 1.0;                                ///< way in the world over way of the hand [1]
  std::vector<double> offset;  ///< place of the workspace in the world [m]; empty or three
};

/// Declares --device, --firmware, --motors-per-torque, --max-force, --scale, --offset, --clutch,
/// --grip.
void declareDeviceOptions(Arguments& arguments, DeviceOptions& options);

/// Throws UsageError that names the option and the allowed values.
void checkDeviceOptions(const DeviceOptions& options);

}  // namespace tandem::demos
