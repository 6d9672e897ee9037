#pragma once

#include <memory>

#include "tandem/falcon/simulated_device.h"

#include "world/scene_frame.h"

namespace tandem::demos {

/// A user's simulated device and hand, as the scenario has them. `site` counts from 0. Throws
/// UsageError for a hand's file that cannot be used.
[[nodiscard]] std::unique_ptr<SimulatedDevice> makeScenarioDevice(const Scenario& scenario,
                                                                  const SceneFrame& frame,
                                                                  int site);

}  // namespace tandem::demos
