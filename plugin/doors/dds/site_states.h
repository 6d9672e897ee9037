#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tandem/coordination/link.h"

namespace tandem {

/// A site as it is at one moment: its user's hand and its copies of the shared objects.
struct SiteStates {
  PeerId site{};
  std::uint64_t tick = 0;       ///< ticks of the site so far; 0: unknown
  double time = 0.0;            ///< of the site since the start [s]
  PointState hand;              ///< the haptic interface point
  std::optional<Vec3> force_W;  ///< on the hand [N]; empty: unknown
  std::vector<ObjectState> objects;
};

}  // namespace tandem
