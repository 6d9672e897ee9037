#pragma once

#include <vector>

#include "bench/scenes/bench_scene.h"

namespace tandem::demos::bench {

/// The true motion of a scene, to the reference's accuracy.
struct ReferenceRun {
  std::vector<SceneState> states;  ///< state n at n / kGridRate, to the end of the scene
};

}  // namespace tandem::demos::bench
