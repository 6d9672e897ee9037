#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace tandem::demos {

/// The text of a scenario that has a file of another format as its world: gravity, no scripted
/// hands, and gains that are calm with most bodies of 0.1 to 3 kg.
[[nodiscard]] std::string describeFileScenario(const std::filesystem::path& file);

/// Puts the hands of users that have no place yet beside the first shared body, and the camera
/// before it. Throws UsageError that names the bodies if none is shared.
void placeUsers(Scenario& scenario);

/// `overrides`, and one that shares bodies of these names.
[[nodiscard]] std::vector<std::string> addShares(std::vector<std::string> overrides,
                                                 const std::vector<std::string>& names);

}  // namespace tandem::demos
