#pragma once

#include "device/device_task.h"
#include "scenario/scenario.h"

namespace tandem::demos {

/// The cube on the floor, or the scenario of the command; the other user is absent. Throws as
/// loadScenario.
[[nodiscard]] Scenario makeFeelScenario(const DeviceTask& task);

}  // namespace tandem::demos
