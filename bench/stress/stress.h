#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/stress/stability_map.h"
#include "bench/stress/stress_run.h"

namespace tandem::demos::bench {

/// Kinds of failure of a case.
enum class StressFailure { kCrash, kNotFinite, kEnergy, kJump, kExplosion, kReference, kPin };
inline constexpr int kStressFailureCount = 7;
[[nodiscard]] std::string_view nameOf(StressFailure failure);

/// All failures of a case; empty if it is good.
[[nodiscard]] std::vector<StressFailure> findFailures(const StressOutcome& outcome);

struct StressOptions {
  std::uint64_t seed = 1;
  std::uint64_t cases = 20000;
  std::uint64_t joined_cases = 1000;  ///< besides, of kJoined
  bool quick = false;
  int workers = 2;  ///< number of processes
};

/// Result of `tandem bench stress`.
struct StressResult {
  StressOptions options;
  std::vector<StressOutcome> outcomes;  ///< ordered by index
  std::vector<StabilityMap> maps;
  double seconds = 0.0;

  [[nodiscard]] std::size_t countFailed() const;
};

/// Called with the current activity and the finished share of the work.
using StressProgress = std::function<void(std::string_view, double)>;

/// Runs all cases in worker processes, so that a crash is one failure and not the end; then the
/// maps. Throws tandem::Error if no process can be started.
[[nodiscard]] StressResult measureStress(const StressOptions& options,
                                         const StressProgress& progress);

}  // namespace tandem::demos::bench
