#pragma once

#include <string>

#include "plot/figure.h"
#include "plot/grouping.h"

namespace tandem::demos::plot {

/// Outcome against the device's own damping, a line per scheme: the three measures of coherency for
/// cooperation, contact changes and largest force for user-to-user contact.
[[nodiscard]] Figure sweepFigure(const Sweep& sweep, const std::string& name);

}  // namespace tandem::demos::plot
