#pragma once

#include <vector>

#include "tandem/falcon/event_port.h"

#include "device/drivers.h"
#include "device/plugged_in.h"

namespace tandem::demos {

/// The line of a list for a gamepad; it tells what to do if it may not be opened.
[[nodiscard]] PluggedIn toPluggedIn(const GamepadAddress& address);

/// Gamepads, joysticks and wheels plugged in now. Needs no device library.
[[nodiscard]] std::vector<PluggedIn> findPluggedGamepads();

/// Opens a gamepad. Throws what `open` throws.
[[nodiscard]] Driver makeGamepadDriver(EventOpener open, const DeviceOptions& options);

}  // namespace tandem::demos
