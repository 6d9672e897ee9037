#pragma once

#include "plot/grouping.h"
#include "plot/report.h"

namespace tandem::demos::plot {

/// Composes the report on `runs`: what was found, every run's numbers, and the figures that suit
/// the groups. Reads the runs' CSV files; throws UsageError naming file and column.
[[nodiscard]] Report composeReport(const std::vector<Run>& runs, const Grouping& grouping);

}  // namespace tandem::demos::plot
