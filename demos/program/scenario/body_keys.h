#pragma once

#include <vector>

#include "scenario/body_scenario.h"
#include "scenario/keys.h"

namespace tandem::demos {

/// Keys of each table [[body]], in the order of the document.
[[nodiscard]] const std::vector<KeyOf<BodyScenario>>& bodyKeys();

/// Keys of each table of a body's parts.
[[nodiscard]] const std::vector<KeyOf<PartScenario>>& partKeys();

/// Keys of each table [[joint]].
[[nodiscard]] const std::vector<KeyOf<JointScenario>>& jointKeys();

}  // namespace tandem::demos
