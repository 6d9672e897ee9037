#pragma once

#include <functional>
#include <string>

#include "scenario/scenario.h"

namespace tandem::demos {

/// Checks the number of sites, their hands, places and delays. Calls `refuse`, which throws, with a
/// line that names the key.
void checkSites(const Scenario& scenario, const std::function<void(const std::string&)>& refuse);

}  // namespace tandem::demos
