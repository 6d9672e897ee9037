#pragma once

#include "plot/run.h"

namespace tandem::demos::plot {

/// True if two `tandem peer` have written to this folder, and no `tandem run`.
[[nodiscard]] bool isLiveFolder(const std::filesystem::path& dir);

/// Joins what the two sites know: site1.json, site2.json, and from their tables what only both
/// together tell. Throws UsageError naming the file.
[[nodiscard]] Run loadLiveRun(const std::filesystem::path& dir);

}  // namespace tandem::demos::plot
