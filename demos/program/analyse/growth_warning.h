#pragma once

#include <optional>
#include <string>

#include "scenario/scenario.h"

namespace tandem::demos {

/// A line for the user of a scenario whose motion grows while contact lasts, with empty hands.
/// Empty if none does, and for a scenario that cannot be analysed.
[[nodiscard]] std::optional<std::string> warnOfGrowth(const Scenario& scenario);

}  // namespace tandem::demos
