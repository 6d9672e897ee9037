#pragma once

#include "device/device_task.h"
#include "scenario/scenario.h"

namespace tandem::demos {

/// The cube on the floor, or the command's scenario; the other user is absent. Throws like
/// loadScenario().
[[nodiscard]] Scenario makeFeelScenario(const DeviceTask& task);

}  // namespace tandem::demos
