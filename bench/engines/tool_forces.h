#pragma once

#include "bench/scenes/bench_scene.h"
#include "bench/scenes/touch_geometry.h"

namespace tandem::demos::bench {

/// Constant force and coupler force of a tool at `at`, with the target of time `target_time` [N].
[[nodiscard]] inline Vec3 computeHandForce(const BenchScene& scene, const BenchTool& tool,
                                           double target_time, const PointState& at) {
  const auto target = heldTarget(tool, target_time);
  return target ? Vec3(tool.f_W + computeCouplerForce(scene.coupler, *target, at)) : tool.f_W;
}

/// Contact force on tool `i` by the scene's own law and geometry, for engines without such contact
/// [N]. Calls `react(body, f_W, p_W)` with the reaction on each moving body.
template <typename React>
[[nodiscard]] Vec3 computeContactForces(const BenchScene& scene, const SceneState& state,
                                        std::size_t i, React react) {
  Vec3 sum_W = Vec3::Zero();
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Touch touch =
        computeTouch(scene.bodies[b], state.bodies[b], state.tools[i].p_W, scene.tools[i].radius);
    const Vec3 f_W = computeTouchForce(scene.contact, touch, state.tools[i], state.bodies[b]);
    if (f_W == Vec3::Zero()) continue;
    if (!scene.bodies[b].isStatic()) react(b, Vec3(-f_W), touch.p_W);
    sum_W += f_W;
  }
  return sum_W;
}

}  // namespace tandem::demos::bench
