#pragma once

#include <memory>

#include "device/live_device.h"

namespace tandem::demos {

/// Opens the device that `options` name, or the first that is plugged in, placed in the world;
/// `wish` is for a simulated user. Throws UsageError for what cannot be, tandem::Error with the
/// remedy for what is not there.
[[nodiscard]] std::unique_ptr<LiveDevice> openDevice(const DeviceOptions& options,
                                                     const Placement& placement, UserWish wish);

}  // namespace tandem::demos
