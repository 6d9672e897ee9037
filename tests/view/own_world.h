#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "support/checkout.h"

namespace tandem::test {

/// Loads a world of demos/worlds by its name.
inline demos::Scenario loadWorld(const std::string& name,
                                 const std::vector<std::string>& overrides = {}) {
  return demos::loadScenario(tandem::test::inCheckout("demos/worlds/" + name + ".toml"), overrides);
}

}  // namespace tandem::test
