#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "tandem/falcon/haptic_device.h"

#include "device/device_options.h"
#include "device/device_report.h"
#include "device/device_spec.h"
#include "device/emulated_user.h"

namespace tandem::demos {

/// A driver, with functions that a HapticDevice lacks.
struct Driver {
  std::unique_ptr<EmulatedUser> emulated;  ///< null: none; outlives the device
  std::unique_ptr<HapticDevice> device;
  std::function<DeviceReport()> report;   ///< only for the thread that made it
  std::function<std::uint8_t()> pressed;  ///< buttons, wait-free, for any thread; may be empty
  std::optional<std::string> usual_grip;  ///< the switch that holds things without --grip
};

/// Opens the device of `spec`. A Falcon then boots in its own thread. Throws tandem::Error with the
/// remedy if the device is missing or may not be opened, or if the image cannot be read. Throws
/// std::invalid_argument for options out of range.
[[nodiscard]] Driver openDriver(const DeviceSpec& spec, const DeviceOptions& options,
                                UserWish wish);

}  // namespace tandem::demos
