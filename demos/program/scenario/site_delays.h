#pragma once

#include "scenario/scenario.h"

namespace tandem::demos {

/// One-way delay from a site to another, by their places in the scenario [s]: that of
/// `network.delays`, or `network.delay` plus the `delay` of both sites.
[[nodiscard]] inline double computeDelay(const Scenario& scenario, std::size_t from,
                                         std::size_t to) {
  if (!scenario.delays.empty()) return scenario.delays[from][to];
  return scenario.network.delay + scenario.sites[from].delay.value_or(0.0) +
         scenario.sites[to].delay.value_or(0.0);
}

}  // namespace tandem::demos
