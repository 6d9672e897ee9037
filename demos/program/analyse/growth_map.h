#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tandem/coordination/stability_advice.h"

#include "analyse/jobs.h"

namespace tandem::demos {

/// Values of a gain along one side of a map.
struct MapAxis {
  LoopGain gain{};
  bool is_logarithmic = false;
  std::vector<double> values;  ///< rising, in the gain's unit
};

/// Growth over two gains of a loop, all others as they are.
struct GrowthMap {
  LoopSettings loop;
  MapAxis x, y;
  std::vector<double> rates;  ///< of the worst lasting motion [1/s], along x for each y
};

/// Number of points along both sides.
struct MapSize {
  std::size_t x = 60, y = 60;
};

/// `points` values, 2 or more. A gain has them from 1/100 to 30 times its value, at equal ratios; a
/// gain of 0 has them around 100 N/m or 1 N s/m. The delay has them from 0 to 0.2 s or twice its
/// value, at most kLongestDelay, at equal distances.
[[nodiscard]] MapAxis makeMapAxis(const LoopSettings& loop, LoopGain gain, std::size_t points);

/// A map whose rates are still to be computed.
[[nodiscard]] GrowthMap makeMap(const LoopSettings& loop, LoopGain x, LoopGain y,
                                const MapSize& size);

/// Adds a job for each point. The map must keep its place until they are done.
void addMapJobs(GrowthMap& map, Jobs& jobs);

/// A line for each point: both gains and the rate, in SI.
[[nodiscard]] std::string writeCsv(const GrowthMap& map);

}  // namespace tandem::demos
