#pragma once

#include <memory>

#include "device/live_device.h"

namespace tandem::demos {

/// Opens the device of `options`, or the first one plugged in, and places it in the world. `wish`
/// is for a simulated user. Throws UsageError for invalid options, tandem::Error with the remedy
/// for a missing device.
[[nodiscard]] std::unique_ptr<LiveDevice> openDevice(const DeviceOptions& options,
                                                     const Placement& placement, UserWish wish);

}  // namespace tandem::demos
