#pragma once

#include "bench/stress/stress.h"
#include "demos/program/plot/figure.h"

namespace tandem::demos::bench {

/// Stiffness against host step, a panel for each way to simulate.
[[nodiscard]] plot::Figure makeStabilityFigure(const std::vector<StabilityMap>& maps);

}  // namespace tandem::demos::bench
