#include "bench/stress/stress.h"

#include <algorithm>
#include <chrono>

#include <LinearMath/btScalar.h>

#include "tandem/coordination/types.h"

#include "bench/program/case_workers.h"

namespace tandem::demos::bench {
namespace {

/// Limit of the deviation from the reference, over the largest displacement. A float host rounds
/// its values.
constexpr double kMostDeviation = sizeof(btScalar) == sizeof(double) ? 2e-5 : 2e-4;

/// Way beyond the speed limit that counts as rounding [m].
constexpr double kLeastJump = 1e-9;

/// Way by which a joint may open, besides rounding of the host's coordinates [m].
constexpr double kMostPinGap = 1e-6;

/// The case that is run as number `slot`.
std::uint64_t findCase(const StressOptions& options, std::uint64_t slot) {
  return slot < options.cases ? slot : kFirstJoinedCase + slot - options.cases;
}

}  // namespace

std::string_view nameOf(StressFailure failure) {
  constexpr std::string_view kNames[] = {"crash",     "not_finite", "energy", "jump",
                                         "explosion", "reference",  "pin"};
  return kNames[static_cast<int>(failure)];
}

std::vector<StressFailure> findFailures(const StressOutcome& outcome) {
  std::vector<StressFailure> failures;
  if (outcome.crashed) return {StressFailure::kCrash};
  if (!outcome.finite) failures.push_back(StressFailure::kNotFinite);
  if (!(outcome.unaccounted <= outcome.allowed)) failures.push_back(StressFailure::kEnergy);
  if (!(outcome.jump <= kLeastJump)) failures.push_back(StressFailure::kJump);
  if (outcome.is_stable && !(outcome.growth <= kMostGrowth))
    failures.push_back(StressFailure::kExplosion);
  if (!(outcome.deviation <= kMostDeviation)) failures.push_back(StressFailure::kReference);
  if (!(outcome.pin_gap <= kMostPinGap)) failures.push_back(StressFailure::kPin);
  return failures;
}

std::size_t StressResult::countFailed() const {
  return static_cast<std::size_t>(
      std::count_if(outcomes.begin(), outcomes.end(),
                    [](const StressOutcome& outcome) { return !findFailures(outcome).empty(); }));
}

StressResult measureStress(const StressOptions& options, const StressProgress& progress) {
  StressResult result;
  result.options = options;
  const auto start = std::chrono::steady_clock::now();
  result.outcomes = runInWorkers<StressOutcome>(
      options.cases + options.joined_cases, options.workers,
      [&](std::uint64_t slot) {
        StressOutcome outcome =
            runStressCase(drawStressCase(options.seed, findCase(options, slot)));
        outcome.index = slot;
        return outcome;
      },
      [&](std::uint64_t slot) {
        StressOutcome outcome;
        outcome.crashed = true;
        outcome.kind =
            static_cast<std::int32_t>(drawStressCase(options.seed, findCase(options, slot)).kind);
        return outcome;
      },
      [&](double share) { progress("cases", 0.9 * share); });
  for (StressOutcome& outcome : result.outcomes) outcome.index = findCase(options, outcome.index);
  result.maps = makeStabilityMaps(options.quick, [&](std::string_view what, double share) {
    progress(what, 0.9 + 0.1 * share);
  });
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  result.seconds = wall.count();
  return result;
}

}  // namespace tandem::demos::bench
