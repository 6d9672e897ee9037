#pragma once

#include "device/device_command.h"
#include "scenario/scenario.h"

namespace tandem::demos {

/// The cube on the floor, or the scenario of the command; the other user is absent. Throws as
/// loadScenario.
[[nodiscard]] Scenario makeFeelScenario(const DeviceCommand& command);

}  // namespace tandem::demos
