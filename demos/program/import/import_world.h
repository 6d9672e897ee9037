#pragma once

#include <filesystem>

#include "scenario/scenario.h"

namespace tandem::demos {

/// True for a file of another format that has a world: .urdf, .xml (MJCF), .bullet.
[[nodiscard]] bool isWorldFile(const std::filesystem::path& file);

/// Puts bodies and joints of the scenario's world file among its own, shares those that
/// world.share names, and leaves both keys empty, so that the scenario stands alone from here on.
/// Does nothing without such a file. Throws UsageError.
void importWorld(Scenario& scenario);

}  // namespace tandem::demos
