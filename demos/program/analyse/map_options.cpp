#include "analyse/map_options.h"

#include <charconv>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

constexpr std::size_t kFewestPoints = 2, kMostPoints = 400;  // along a side

LoopGain findGain(const std::string& key, const std::string& text) {
  std::vector<std::string> keys;
  for (const LoopGain gain : allLoopGains()) {
    if (key == name(gain)) return gain;
    keys.emplace_back(name(gain));
  }
  throw UsageError(
      fmt::format("--map {}: \"{}\" is no gain; give two of {}", text, key, fmt::join(keys, ", ")));
}

std::optional<std::size_t> parsePoints(const std::string& text) {
  std::size_t points = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, points);
  if (error != std::errc() || rest != end) return std::nullopt;
  if (points < kFewestPoints || points > kMostPoints) return std::nullopt;
  return points;
}

}  // namespace

std::pair<LoopGain, LoopGain> parseMapGains(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos)
    throw UsageError(fmt::format(
        "--map {}: give two gains, such as network.delay,coordination.stiffness", text));
  const LoopGain x = findGain(text.substr(0, comma), text);
  const LoopGain y = findGain(text.substr(comma + 1), text);
  if (x == y) throw UsageError(fmt::format("--map {}: must be two different gains", text));
  return {x, y};
}

MapSize parseMapSize(const std::string& text) {
  const std::size_t by = text.find('x');
  const auto x = parsePoints(text.substr(0, by));
  const auto y = by == std::string::npos ? x : parsePoints(text.substr(by + 1));
  if (!x || !y)
    throw UsageError(fmt::format("--points {}: must be {} to {}, or two of them as 60x40", text,
                                 kFewestPoints, kMostPoints));
  return {*x, *y};
}

}  // namespace tandem::demos
