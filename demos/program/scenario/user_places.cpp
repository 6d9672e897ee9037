#include "scenario/user_places.h"

#include <cmath>

namespace tandem::demos {
namespace {

/// From one user to the next at a face, in radii of their spheres: they must not touch.
constexpr double kSpacing = 2.2;

/// Users in each row of the smallest square that has room for `count`.
std::size_t countColumns(std::size_t count) {
  return static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
}

/// Place `at` of `count` in a line around 0, a step apart.
double placeInLine(std::size_t at, std::size_t count) {
  return static_cast<double>(at) - 0.5 * static_cast<double>(count - 1);
}

}  // namespace

Vec3 computeUserPlace(const Scenario& scenario, std::size_t site) {
  if (scenario.isWorld()) return Vec3::Zero();
  const double radius = scenario.site.proxy.radius;
  if (!scenario.hasObject())
    return (2.0 * static_cast<double>(site) - 1.0) * radius * Vec3::UnitX();
  return computePlaceBeside(scenario, site, radius + 0.5 * scenario.object_size);
}

Vec3 computePlaceBeside(const Scenario& scenario, std::size_t site, double distance) {
  const std::size_t count = countBeside(scenario, site), columns = countColumns(count);
  const std::size_t rows = (count + columns - 1) / columns, place = site / 2;
  const double side = site % 2 == 0 ? -1.0 : 1.0, step = kSpacing * scenario.site.proxy.radius;
  const std::size_t in_row = std::min(columns, count - place / columns * columns);
  return {side * distance, step * placeInLine(place % columns, in_row),
          step * placeInLine(place / columns, rows)};
}

std::size_t countBeside(const Scenario& scenario, std::size_t site) {
  return (scenario.sites.size() + 1 - site % 2) / 2;
}

double computeLeastFace(const Scenario& scenario) {
  const auto steps = static_cast<double>(countColumns(countBeside(scenario, 0)) - 1);
  return steps * kSpacing * scenario.site.proxy.radius;
}

}  // namespace tandem::demos
