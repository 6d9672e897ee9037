#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tandem/coordination/stability_advice.h"

#include "scenario/scenario.h"

namespace tandem::demos {

/// The loop of a scenario; empty for one that cannot be analysed.
[[nodiscard]] std::optional<LoopSettings> findLoop(const Scenario& scenario);

/// "with lasting contact and empty hands, motion against each other doubles in 0.4 s, at 24 Hz"
[[nodiscard]] std::string describeGrowth(const ModeGrowth& worst);

/// Lines for the user of a scenario before a touch: gains that were chosen for him, and motion that
/// grows while contact lasts, with empty hands.
[[nodiscard]] std::vector<std::string> warnBeforeTouch(const Scenario& scenario);

}  // namespace tandem::demos
