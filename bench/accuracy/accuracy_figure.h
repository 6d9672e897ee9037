#pragma once

#include <vector>

#include "bench/accuracy/accuracy.h"
#include "demos/program/plot/figure.h"

namespace tandem::demos::bench {

/// Run time against position error, and against force error: one panel per scene, one line per
/// method through its host rates, log-log.
[[nodiscard]] std::vector<plot::Figure> makeAccuracyFigures(
    const std::vector<SceneAccuracy>& scenes);

}  // namespace tandem::demos::bench
