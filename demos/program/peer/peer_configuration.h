#pragma once

#include "tandem/coordination/configuration.h"

#include "scenario/scenario.h"

namespace tandem::demos {

/// Settings that must be equal at all sites of a scenario: their number, world, masses, gains and
/// rates. It excludes a user's own hand and device, and keys of a simulated network.
[[nodiscard]] Configuration makePeerConfiguration(const Scenario& scenario);

}  // namespace tandem::demos
