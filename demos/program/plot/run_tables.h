#pragma once

#include <vector>

#include "plot/grouping.h"
#include "plot/html.h"

namespace tandem::demos::plot {

/// One row per run of that kind: what was asked, and what was reached, with the paper's outcome
/// below a number where the settings are the paper's. No rows when there is no such run.
[[nodiscard]] HtmlTable runTable(const std::vector<Run>& runs, RunKind kind);

/// Contact by case and scheme: changes, verdict, largest force.
[[nodiscard]] HtmlTable contactTable(const std::vector<SchemeGroup>& cases);

/// What holds at each point of a sweep.
[[nodiscard]] HtmlTable sweepTable(const Sweep& sweep);

/// A scheme's name with a patch of its colour.
[[nodiscard]] std::string schemeCell(const std::string& scheme);

}  // namespace tandem::demos::plot
