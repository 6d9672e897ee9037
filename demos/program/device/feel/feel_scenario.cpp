#include "device/feel/feel_scenario.h"

#include <string>

#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

/// The workspace's middle is above the cube. Its sides, its top and the floor are in reach.
constexpr const char* kCubeOnFloor = R"(
title = "A free cube on a floor"
[experiment]
kind = "playground"
guide = false
[contact]
stiffness = 1000.0
damping = 5.0
[object]
mass = 0.4
size = 0.04
[site1]
start_offset = [0.03, 0.0, 0.045]
[rates]
haptic = 1000.0
host = 60.0
[world]
gravity = 9.81
floor = true
friction = 0.6
)";

}  // namespace

Scenario makeFeelScenario(const DeviceTask& task) {
  Scenario scenario = task.scenario ? loadScenario(*task.scenario, {})
                                    : parseScenario(kCubeOnFloor, "the built-in scene", {});
  if (scenario.site.contact_model != ContactModel::kIsland ||
      scenario.site.injection != Injection::kHandoff)
    throw UsageError(
        "--scenario: tandem device needs contact.model = island and bridge.injection = handoff; "
        "the "
        "others have no haptic rate of their own");
  if (task.device.grip && !scenario.mayGrip())
    throw UsageError(std::string("--grip: ") + kGripNeeds);
  scenario.site.link_loss.start_live = false;
  return scenario;
}

}  // namespace tandem::demos
