#pragma once

#include <memory>

#include "device/exchange.h"
#include "device/live_device.h"
#include "scenario/scenario.h"

namespace tandem::demos {

/// Throws UsageError if the options let the user hold things, but the scenario or the device does
/// not.
void checkGrip(const DeviceOptions& options, const Scenario& scenario);

/// Opens the user's own device at the user's start, once it is ready; `site` is 0 or 1. Null
/// without --device. Sets `is_ended` if `pause` asks to end. Throws as openDevice() and getReady().
[[nodiscard]] std::unique_ptr<LiveDevice> openUsersDevice(const DeviceOptions& options,
                                                          const Scenario& scenario, int site,
                                                          bool is_quiet, const Pause& pause,
                                                          bool& is_ended);

/// Opens the device of user 2 at the machine of user 1, as openUsersDevice() does. Both look at one
/// picture, so "away" is the same for both. Without --grip the centre button of a Falcon is one.
[[nodiscard]] std::unique_ptr<LiveDevice> openSecondDevice(DeviceOptions options,
                                                           const Scenario& scenario, bool is_quiet,
                                                           const Pause& pause, bool& is_ended);

}  // namespace tandem::demos
