#pragma once

#include "tandem/coordination/stability.h"

#include "scenario/scenario.h"

namespace tandem::demos {

/// The loop that a scenario closes: equal users along one line. Throws UsageError with the reason
/// for a scenario that has none.
[[nodiscard]] LoopSettings makeLoop(const Scenario& scenario);

}  // namespace tandem::demos
