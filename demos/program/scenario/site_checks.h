#pragma once

#include <functional>
#include <string>

#include "scenario/scenario.h"

namespace tandem::demos {

/// Checks the number of sites, their hands, places and delays. Calls `refuse`, which throws, with a
/// line that names the key.
void checkSites(const Scenario& scenario, const std::function<void(const std::string&)>& refuse);

/// For what plays two sites only. Throws UsageError, which begins with `who`, if there are more.
void requireTwoSites(const Scenario& scenario, const std::string& who);

}  // namespace tandem::demos
