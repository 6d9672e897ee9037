#pragma once

#include "bench/accuracy/accuracy.h"
#include "bench/reference/reference_run.h"

namespace tandem::demos::bench {

/// Differences of one state to the true one. Both have the same target, so a coupler's force
/// differs by K dx + B dv.
[[nodiscard]] RunErrors compareStates(const BenchScene& scene, const SceneState& state,
                                      const SceneState& truth);

/// Largest differences between two references of one scene.
[[nodiscard]] RunErrors compareReferences(const BenchScene& scene, const ReferenceRun& a,
                                          const ReferenceRun& b);

/// Runs `simulation` to the end of the scene. Compares it at the end of every host step, and its
/// tools at every tick that it knows. Empty if it leaves all bounds.
[[nodiscard]] std::optional<RunErrors> compareRun(const BenchScene& scene, int host_rate,
                                                  Simulation& simulation,
                                                  const ReferenceRun& reference);

}  // namespace tandem::demos::bench
