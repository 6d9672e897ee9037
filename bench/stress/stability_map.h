#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tandem::demos::bench {

enum class Stability { kStable, kGrows, kNotFinite, kNotApplicable };
[[nodiscard]] std::string_view nameOf(Stability stability);

/// One method over a grid of stiffness and host step.
struct StabilityMap {
  std::string method;
  std::vector<double> stiffness;  ///< stiffness of contact and coupler [N/m]
  std::vector<int> host_rates;    ///< [Hz]
  std::vector<Stability> cells;   ///< ordered by stiffness, then rate
  [[nodiscard]] Stability at(std::size_t k, std::size_t r) const {
    return cells[k * host_rates.size() + r];
  }
};

/// The scene of the maps: a sphere on a coupler presses on a fixed cube. Its target lies in the
/// cube, and it is released from outside.
struct MapScene {
  static constexpr double kMass = 0.1;           ///< [kg]
  static constexpr double kDampingRatio = 0.05;  ///< ratio of coupler and contact together [1]
};

/// Longest step of force injection (semi-implicit Euler) with contact and coupler of this stiffness
/// each: (2 / w) (sqrt(z^2 + 1) - z) [s].
[[nodiscard]] double computeInjectionLimit(double stiffness);

/// Runs the plugin, force injection and Bullet's own means over the grid.
[[nodiscard]] std::vector<StabilityMap> makeStabilityMaps(
    bool quick, const std::function<void(std::string_view, double)>& progress);

}  // namespace tandem::demos::bench
