#pragma once

#include <optional>
#include <string>

#include "scenario/scenario.h"

namespace tandem::demos {

/// Chooses the gains that a scenario leaves to its delay (tandem::chooseCoordination). Without
/// effect if there are none. Throws UsageError for a scenario that cannot be analysed.
void chooseGains(Scenario& scenario);

/// A line for the user about gains that were chosen; empty if none were.
[[nodiscard]] std::optional<std::string> tellChosenGains(const Scenario& scenario);

}  // namespace tandem::demos
