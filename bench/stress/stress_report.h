#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "bench/stress/stress.h"

namespace tandem::demos::bench {

/// stress.json: counts and worst values by kind, every failed case, and the maps. Every run on one
/// machine gives the same, except `seconds`.
[[nodiscard]] nlohmann::json makeStressJson(const StressResult& result);

/// The same as a table for readers.
[[nodiscard]] std::string makeStressTable(const StressResult& result);

/// A case and its energy account over time, for readers.
[[nodiscard]] std::string describeCase(const StressCase& one);
/// All inputs and the outcome of a case.
[[nodiscard]] nlohmann::json makeCaseJson(const StressCase& one, const StressOutcome& outcome);

}  // namespace tandem::demos::bench
