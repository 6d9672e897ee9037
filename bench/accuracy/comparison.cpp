#include "bench/accuracy/comparison.h"

#include <algorithm>
#include <cmath>

namespace tandem::demos::bench {
namespace {

/// A body farther than this from its true place is lost [m].
constexpr double kLost = 1.0;

RunErrors compareTool(const BenchScene& scene, std::size_t i, const PointState& tool,
                      const PointState& truth) {
  const Vec3 dp = tool.p_W - truth.p_W;
  RunErrors errors;
  errors.tool = dp.norm();
  if (scene.tools[i].device)
    errors.force =
        (scene.coupler.stiffness * dp + scene.coupler.damping * (tool.v_W - truth.v_W)).norm();
  return errors;
}

/// Written so that NaN counts as lost.
bool isLost(const RunErrors& errors) {
  return !(errors.tool < kLost && errors.body < kLost && std::isfinite(errors.force));
}

}  // namespace

void RunErrors::include(const RunErrors& other) {
  tool = std::max(tool, other.tool);
  body = std::max(body, other.body);
  force = std::max(force, other.force);
}

RunErrors compareStates(const BenchScene& scene, const SceneState& state, const SceneState& truth) {
  RunErrors errors;
  for (std::size_t i = 0; i < scene.tools.size(); ++i) {
    const RunErrors one = compareTool(scene, i, state.tools[i], truth.tools[i]);
    if (isLost(one)) return one;
    errors.include(one);
  }
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (scene.bodies[b].isStatic()) continue;
    RunErrors one;
    one.body = (state.bodies[b].p_W - truth.bodies[b].p_W).norm();
    if (isLost(one)) return one;
    errors.include(one);
  }
  return errors;
}

RunErrors compareReferences(const BenchScene& scene, const ReferenceRun& a, const ReferenceRun& b) {
  RunErrors errors;
  for (std::size_t n = 0; n < a.states.size(); ++n)
    errors.include(compareStates(scene, a.states[n], b.states[n]));
  return errors;
}

std::optional<RunErrors> compareRun(const BenchScene& scene, int host_rate, Simulation& simulation,
                                    const ReferenceRun& reference) {
  RunErrors errors;
  SceneState state = startState(scene);
  simulation.keepTicks();
  const std::size_t stride = static_cast<std::size_t>(kGridRate / host_rate);
  for (std::size_t n = stride; n < reference.states.size(); n += stride) {
    simulation.step();
    simulation.read(state);
    const RunErrors one = compareStates(scene, state, reference.states[n]);
    if (isLost(one)) return std::nullopt;
    errors.include(one);
  }
  for (const TickSample& sample : simulation.tickSamples()) {
    const std::size_t n = sample.tick * (kGridRate / kTargetRate);
    if (n >= reference.states.size()) continue;
    const auto tool = static_cast<std::size_t>(sample.tool);
    const RunErrors one = compareTool(scene, tool, sample.state, reference.states[n].tools[tool]);
    if (isLost(one)) return std::nullopt;
    errors.include(one);
  }
  return errors;
}

}  // namespace tandem::demos::bench
