#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/accuracy/accuracy.h"

namespace tandem::demos::bench {

/// A table for readers: one block per scene, one row per method, one column per host rate.
[[nodiscard]] std::string makeAccuracyTable(const std::vector<SceneAccuracy>& scenes);

/// accuracy.json; docs/benchmarks.md describes its contents.
[[nodiscard]] nlohmann::json makeAccuracyJson(const std::vector<SceneAccuracy>& scenes, bool quick);

}  // namespace tandem::demos::bench
