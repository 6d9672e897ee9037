#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/stress/stability_map.h"
#include "bench/stress/stress_run.h"

namespace tandem::demos::bench {

/// What can be wrong with a case.
enum class StressFailure { kCrash, kNotFinite, kEnergy, kJump, kExplosion, kReference };
inline constexpr int kStressFailureCount = 6;
[[nodiscard]] std::string_view nameOf(StressFailure failure);

/// Everything that is wrong; empty: the case is good.
[[nodiscard]] std::vector<StressFailure> findFailures(const StressOutcome& outcome);

struct StressOptions {
  std::uint64_t seed = 1;
  std::uint64_t cases = 20000;
  bool quick = false;
  int workers = 2;  ///< processes
};

/// What `tandem bench stress` found.
struct StressResult {
  StressOptions options;
  std::vector<StressOutcome> outcomes;  ///< by index
  std::vector<StabilityMap> maps;
  double seconds = 0.0;

  [[nodiscard]] std::size_t countFailed() const;
};

/// Told what is being done and which share of it all is done.
using StressProgress = std::function<void(std::string_view, double)>;

/// Runs all cases in worker processes, so that one that crashes is a failure and not the end, and
/// the maps. Throws tandem::Error where no process can be started.
[[nodiscard]] StressResult measureStress(const StressOptions& options,
                                         const StressProgress& progress);

}  // namespace tandem::demos::bench
