#include "bench/scenes/bench_scene.h"

#include <cmath>

namespace tandem::demos::bench {
namespace {

Vec3 computeBoxInertia(const Vec3& h, double mass) {
  return mass / 3.0 *
         Vec3(h.y() * h.y() + h.z() * h.z(), h.x() * h.x() + h.z() * h.z(),
              h.x() * h.x() + h.y() * h.y());
}

}  // namespace

std::optional<PointState> heldTarget(const BenchTool& tool, double t) {
  if (!tool.device) return std::nullopt;
  // The slack covers rounding: times meant as multiples count as multiples.
  return tool.device(std::floor(t * kTargetRate + 1e-6) / kTargetRate);
}

Vec3 computeInertia(const BenchBody& body) {
  if (const auto* box = std::get_if<BoxShape>(&body.shape))
    return computeBoxInertia(box->half_extents, body.mass);
  if (const auto* sphere = std::get_if<SphereShape>(&body.shape))
    return Vec3::Constant(0.4 * body.mass * sphere->radius * sphere->radius);
  return Vec3::Zero();
}

SceneState startState(const BenchScene& scene) {
  SceneState state;
  for (const BenchTool& tool : scene.tools) state.tools.push_back(tool.start);
  for (const BenchBody& body : scene.bodies) state.bodies.push_back(body.start);
  return state;
}

}  // namespace tandem::demos::bench
