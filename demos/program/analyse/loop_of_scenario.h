#pragma once

#include "tandem/coordination/stability.h"

#include "scenario/scenario.h"

namespace tandem::demos {

/// The loop that a scenario closes: users along one line. Throws UsageError with the reason
/// for a scenario that has none.
[[nodiscard]] LoopSettings makeLoop(const Scenario& scenario);

/// The scheme of that kind of stand-in, as scenarios name it.
[[nodiscard]] const char* schemeOf(StandInKind kind) noexcept;

}  // namespace tandem::demos
