#include "device/bars.h"

#include <algorithm>
#include <cmath>

namespace tandem::demos {
namespace {

/// Number of filled places out of `width`; 0 for NaN.
std::size_t countPlaces(double share, int width) {
  if (!(share > 0.0)) return 0;
  return static_cast<std::size_t>(std::lround(std::min(share, 1.0) * width));
}

}  // namespace

std::string makeLevel(double value, double most, int width) {
  const std::size_t full = countPlaces(value / most, width);
  return "[" + std::string(full, '#') + std::string(static_cast<std::size_t>(width) - full, ' ') +
         "]";
}

std::string makeBar(double value, double most, int width) {
  const auto side = static_cast<std::size_t>(width);
  std::string bar(2 * side + 1, ' ');
  bar[side] = '|';
  const std::size_t full = countPlaces(std::abs(value) / most, width);
  for (std::size_t i = 1; i <= full; ++i) bar[value < 0.0 ? side - i : side + i] = '#';
  return "[" + bar + "]";
}

std::string makeShare(double share, int width) {
  const std::size_t full = countPlaces(share, width);
  return std::string(share > 0.0 ? std::max<std::size_t>(full, 1) : full, '#');
}

}  // namespace tandem::demos
