#pragma once

#include <nlohmann/json.hpp>

#include "tandem/plugin/site.h"

namespace tandem::demos {

/// In how many ticks a site's guards changed the force, and its account of energy.
inline nlohmann::json describeGuards(const SiteCounters& counters,
                                     const PassivityObserver& passivity) {
  return {{"clamped", counters.force_clamped},
          {"slewed", counters.force_slewed},
          {"energy_limited", counters.energy_limited},
          {"energy_in", passivity.own()},
          {"energy_lowest", passivity.lowest()}};
}

}  // namespace tandem::demos
