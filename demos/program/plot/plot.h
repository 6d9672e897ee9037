#pragma once

#include <filesystem>
#include <vector>

namespace tandem::demos {

/// Turns run folders into figures and one self-contained report, the program's `plot` command.
///
/// Writes `report.html` into the first folder and the figures, SVG and PNG, into its sub-folder
/// `figures`, which belongs to this command: pictures of an earlier report there are removed. All
/// is drawn aside first, so a failure leaves what was there. Prints the report's path to stdout.
/// Throws UsageError for missing or broken input, Error when gnuplot or the disk fails.
void plotRuns(const std::vector<std::filesystem::path>& run_dirs);

}  // namespace tandem::demos
