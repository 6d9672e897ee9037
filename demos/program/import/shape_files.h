#pragma once

#include "scenario/scenario.h"

namespace tandem::demos {

/// Puts the points and triangles of all files of hulls and meshes into the scenario, which then
/// stands without them: at a peer, and in the summary of a run. Throws UsageError as readObj()
/// does.
void readShapeFiles(Scenario& scenario);

}  // namespace tandem::demos
