#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "bench/speed/speed.h"
#include "demos/program/plot/figure.h"

namespace tandem::demos::bench {

[[nodiscard]] std::string makeSpeedTable(const SpeedReport& report);

/// As docs/benchmarks.md describes it.
[[nodiscard]] nlohmann::json makeSpeedJson(const SpeedReport& report, bool quick);

/// Run time per simulated second against bodies of the host and against shared objects.
[[nodiscard]] plot::Figure makeSpeedFigure(const SpeedReport& report);

}  // namespace tandem::demos::bench
