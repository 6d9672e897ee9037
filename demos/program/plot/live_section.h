#pragma once

#include <vector>

#include "plot/report.h"
#include "plot/run.h"

namespace tandem::demos::plot {

/// Runs against the clock over real sockets, each beside the run in virtual time that was asked for
/// the same, if that is among `runs`. Nothing if there are none.
void addLive(Report& report, const std::vector<Run>& runs);

}  // namespace tandem::demos::plot
