#pragma once

#include "tandem/coordination/configuration.h"

#include "scenario/scenario.h"

namespace tandem::demos {

/// What both sites of a scenario must have alike: the world, masses, gains and rates, but not what
/// a user's own hand and device do, and not what only a simulated network has.
[[nodiscard]] Configuration makePeerConfiguration(const Scenario& scenario);

}  // namespace tandem::demos
