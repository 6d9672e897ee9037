#pragma once

#include <functional>
#include <memory>

#include "tandem/falcon/haptic_device.h"

#include "device/device_options.h"
#include "device/device_report.h"
#include "device/device_spec.h"
#include "device/emulated_user.h"

namespace tandem::demos {

/// A driver with what a HapticDevice does not tell.
struct Driver {
  std::unique_ptr<EmulatedUser> emulated;  ///< null: there is none; outlives the device
  std::unique_ptr<HapticDevice> device;
  std::function<DeviceReport()> report;   ///< for one thread, the one that made it
  std::function<std::uint8_t()> pressed;  ///< buttons, wait-free, for any; may be empty
};

/// Opens what `spec` names. A Falcon then boots by itself, in its own thread. Throws tandem::Error
/// with the remedy if it is not there or may not be opened, or the image cannot be read;
/// std::invalid_argument for options out of range.
[[nodiscard]] Driver openDriver(const DeviceSpec& spec, const DeviceOptions& options,
                                UserWish wish);

}  // namespace tandem::demos
