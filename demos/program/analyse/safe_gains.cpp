#include "analyse/safe_gains.h"

#include <fmt/format.h>

#include "tandem/coordination/safe_coordination.h"

#include "analyse/loop_of_scenario.h"
#include "scenario/site_delays.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

LoopSettings makeLoopToChooseFor(const Scenario& scenario) {
  try {
    return makeLoop(scenario);
  } catch (const UsageError& error) {
    throw UsageError(
        fmt::format("coordination = \"auto\": {}; give coordination.stiffness and "
                    "coordination.damping",
                    error.what()));
  }
}

}  // namespace

void chooseGains(Scenario& scenario) {
  if (!scenario.automatic.hasAny()) return;
  CouplerGains& gains = scenario.site.coordination;
  GivenCoordination given;
  if (!scenario.automatic.stiffness) given.stiffness = gains.stiffness;
  if (!scenario.automatic.damping) given.damping = gains.damping;
  try {
    gains = chooseCoordination(makeLoopToChooseFor(scenario), given).gains;
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format("coordination = \"auto\": {}", error.what()));
  }
}

std::optional<std::string> tellChosenGains(const Scenario& scenario) {
  if (!scenario.automatic.hasAny()) return std::nullopt;
  const CouplerGains& gains = scenario.site.coordination;
  return fmt::format("coordination for {:.3g} ms: stiffness {:.3g} N/m, damping {:.3g} N s/m",
                     1e3 * computeDelay(scenario, 0, 1), gains.stiffness, gains.damping);
}

}  // namespace tandem::demos
