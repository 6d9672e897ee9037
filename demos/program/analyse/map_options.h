#pragma once

#include <string>
#include <utility>

#include "analyse/growth_map.h"

namespace tandem::demos {

/// Two different gains by their keys: "network.delay,coordination.stiffness". Throws UsageError.
[[nodiscard]] std::pair<LoopGain, LoopGain> parseMapGains(const std::string& text);

/// Points of a map: "60", or "60x40" for along x and along y. Throws UsageError.
[[nodiscard]] MapSize parseMapSize(const std::string& text);

}  // namespace tandem::demos
