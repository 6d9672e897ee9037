#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "bench/speed/speed.h"

namespace tandem::demos::bench {

[[nodiscard]] std::string makeSpeedTable(const SpeedReport& report);

/// docs/benchmarks.md describes the format.
[[nodiscard]] nlohmann::json makeSpeedJson(const SpeedReport& report, bool quick);

}  // namespace tandem::demos::bench
