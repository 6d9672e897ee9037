#pragma once

#include <vector>

#include "world/scene.h"

namespace tandem::demos {

/// Hands and bodies are here; another session goes on from there.
struct ScenePlaces {
  std::vector<Vec3> hands_W;  ///< of all users [m]
  BodyPlaces bodies;          ///< as one site has them

  /// False if something is beyond the 1000 m of packets, after a motion that grew without bounds.
  [[nodiscard]] bool areNear() const;
};

/// Lets the hands of a scenario begin at these places.
void startHandsAt(const ScenePlaces& places, Scenario& scenario);

}  // namespace tandem::demos
