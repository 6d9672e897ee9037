#pragma once

#include <functional>
#include <string>

#include "scenario/scenario.h"

namespace tandem::demos {

/// Checks the bodies and joints of a scenario, each and together. Calls `refuse`, which throws,
/// with a line that names the key.
void checkBodies(const Scenario& scenario, const std::function<void(const std::string&)>& refuse);

}  // namespace tandem::demos
