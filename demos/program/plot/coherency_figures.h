#pragma once

#include <vector>

#include "plot/figure.h"
#include "plot/grouping.h"

namespace tandem::demos::plot {

/// Bars of the mean distance between the two object copies, by scheme: at equal time, and as each
/// site received the other copy. Where the settings are the paper's, its outcomes are marked.
[[nodiscard]] Figure coherencyBars(const SchemeGroup& group, const std::string& name);

/// Distance between the two object copies over time, schemes in one panel.
[[nodiscard]] Figure coherencyOverTime(const SchemeGroup& group, const std::string& name);

}  // namespace tandem::demos::plot
