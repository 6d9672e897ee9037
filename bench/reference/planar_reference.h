#pragma once

#include "bench/reference/planar_scene.h"
#include "bench/reference/reference_run.h"

namespace tandem::demos::bench {

/// The scene's x-z plane, with heights along the plane's y; the same bodies and tools in the same
/// order. Throws std::invalid_argument for motion that leaves the plane.
[[nodiscard]] PlanarScene makePlanarScene(const BenchScene& scene);

/// Solves a scene by PlanarSolver at `rate` steps per second, a multiple of kGridRate.
[[nodiscard]] ReferenceRun runPlanarReference(const BenchScene& scene, int rate);

}  // namespace tandem::demos::bench
