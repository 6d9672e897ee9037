#pragma once

#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace tandem::demos {

/// A body of a scene, and what it is there for.
struct PlannedBody {
  BodyScenario body;
  std::string role;  ///< object, neighbour or obstacle
};

/// The bodies of any scenario in the order in which a world gets them: the floor, boxes, the cube,
/// and those of its tables [[body]].
[[nodiscard]] std::vector<PlannedBody> planBodies(const Scenario& scenario);

}  // namespace tandem::demos
