#pragma once

#include "device/device_task.h"

namespace tandem::demos {

/// `tandem device` without a command: the user homes the device and feels a free cube on a floor,
/// alone. A haptic thread ticks the site; this thread steps the host's world at 60 Hz. Ends when
/// `pause` returns true or task.duration is over; then the force fades. Throws like the other
/// commands.
void feelCube(const DeviceTask& task, const Pause& pause);

}  // namespace tandem::demos
