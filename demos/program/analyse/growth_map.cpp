#include "analyse/growth_map.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

namespace tandem::demos {
namespace {

constexpr double kLess = 100.0, kMore = 30.0;                   // times a gain's value, down and up
constexpr double kUsualDelay = 0.2;                             // longest of a map [s]
constexpr double kUsualDamping = 1.0, kUsualStiffness = 100.0;  // of a gain that is 0

double findMiddle(const LoopSettings& loop, LoopGain gain) {
  const double value = valueOf(loop, gain);
  if (value > 0.0) return value;
  return std::string_view(unit(gain)) == "N/m" ? kUsualStiffness : kUsualDamping;
}

}  // namespace

MapAxis makeMapAxis(const LoopSettings& loop, LoopGain gain, std::size_t points) {
  MapAxis axis{gain, gain != LoopGain::kDelay, {}};
  const double value = valueOf(loop, gain);
  const double longest = std::min(std::max(kUsualDelay, 2.0 * value), kLongestDelay);
  const double middle = findMiddle(loop, gain);
  for (std::size_t i = 0; i < points; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(points - 1);
    axis.values.push_back(axis.is_logarithmic ? middle / kLess * std::pow(kLess * kMore, share)
                                              : longest * share);
  }
  return axis;
}

GrowthMap makeMap(const LoopSettings& loop, LoopGain x, LoopGain y, const MapSize& size) {
  GrowthMap map{loop, makeMapAxis(loop, x, size.x), makeMapAxis(loop, y, size.y), {}};
  map.rates.resize(size.x * size.y);
  return map;
}

void addMapJobs(GrowthMap& map, Jobs& jobs) {
  const std::size_t width = map.x.values.size();
  for (std::size_t i = 0; i < map.rates.size(); ++i)
    jobs.emplace_back([&map, i, width] {
      LoopSettings there = map.loop;
      setValue(there, map.x.gain, map.x.values[i % width]);
      setValue(there, map.y.gain, map.y.values[i / width]);
      map.rates[i] = computeWorstRate(there);
    });
}

std::string writeCsv(const GrowthMap& map) {
  std::string text = fmt::format("{},{},rate\n", name(map.x.gain), name(map.y.gain));
  std::size_t i = 0;
  for (const double y : map.y.values)
    for (const double x : map.x.values)
      text += fmt::format("{:.6g},{:.6g},{:.6g}\n", x, y, map.rates[i++]);
  return text;
}

}  // namespace tandem::demos
