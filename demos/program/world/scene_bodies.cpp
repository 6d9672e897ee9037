#include "world/scene_bodies.h"

namespace tandem::demos {
namespace {

constexpr double kFloorThickness = 0.1;  // [m]
constexpr double kFloorWidth = 2.0;      // [m]

BodyScenario makeBox(const std::string& name, const Vec3& size, double mass, const Vec3& p_S) {
  BodyScenario box;
  box.name = name;
  box.shape.size = size;
  box.mass = mass;
  box.position = p_S;
  return box;
}

/// Lies under the cube; in a world its top is at height 0.
BodyScenario makeFloor(const Scenario& scenario) {
  const double top = scenario.isWorld() ? 0.0 : -0.5 * scenario.object_size;
  return makeBox("floor", Vec3(kFloorWidth, kFloorWidth, kFloorThickness), 0.0,
                 Vec3(0, 0, top - 0.5 * kFloorThickness));
}

BodyScenario makeCube(const Scenario& scenario) {
  BodyScenario cube =
      makeBox("cube", Vec3::Constant(scenario.object_size), scenario.object_mass, Vec3::Zero());
  cube.shared = true;
  cube.damping = scenario.object_damping;
  return cube;
}

}  // namespace

std::vector<PlannedBody> planBodies(const Scenario& scenario) {
  std::vector<BodyScenario> bodies;
  if (scenario.floor) bodies.push_back(makeFloor(scenario));
  for (const NeighbourBox& box : scenario.boxes)
    bodies.push_back(makeBox("box" + std::to_string(bodies.size() + (scenario.floor ? 0 : 1)),
                             Vec3::Constant(box.size), box.mass, box.position));
  if (!scenario.isWorld() && scenario.hasObject()) bodies.push_back(makeCube(scenario));
  bodies.insert(bodies.end(), scenario.bodies.begin(), scenario.bodies.end());
  std::vector<PlannedBody> plan;
  for (BodyScenario& body : bodies) {
    const char* role = body.shared ? "object" : body.mass > 0.0 ? "neighbour" : "obstacle";
    plan.push_back({std::move(body), role});
  }
  return plan;
}

}  // namespace tandem::demos
