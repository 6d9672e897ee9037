#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace tandem::test {

/// Loads a world of demos/worlds by its name.
inline demos::Scenario loadWorld(const std::string& name,
                                 const std::vector<std::string>& overrides = {}) {
  return demos::loadScenario(std::filesystem::path(TANDEM_WORLDS) / (name + ".toml"), overrides);
}

}  // namespace tandem::test
