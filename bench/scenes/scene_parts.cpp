#include "bench/scenes/scene_parts.h"

#include <cmath>

namespace tandem::demos::bench {
namespace {

/// Finished part of a leg's way at s in [0, 1] of its time, and its slope.
std::pair<double, double> computeShare(double s, double ease) {
  const double top = 1.0 / (1.0 - ease);  // slope in the middle
  if (s <= 0.0) return {0.0, 0.0};
  if (s >= 1.0) return {1.0, 0.0};
  if (s < ease) return {0.5 * top * s * s / ease, top * s / ease};
  if (s > 1.0 - ease)
    return {1.0 - 0.5 * top * (1.0 - s) * (1.0 - s) / ease, top * (1.0 - s) / ease};
  return {top * (s - 0.5 * ease), top};
}

/// A device that moves one leg after another and stands still between them.
std::function<PointState(double)> makeDevice(const Vec3& start_W, std::vector<Leg> legs) {
  return [start_W, legs = std::move(legs)](double t) {
    PointState device{start_W, Vec3::Zero()};
    for (const Leg& leg : legs) {
      const auto [share, slope] = computeShare((t - leg.start) / leg.time, leg.ease);
      device.p_W += share * leg.way;
      device.v_W += slope / leg.time * leg.way;
    }
    return device;
  };
}

BenchBody makeFloor() {
  BenchBody floor;
  floor.name = "floor";
  floor.shape = PlaneShape{};
  return floor;
}

}  // namespace

BenchTool makeTool(const Vec3& start_W, std::vector<Leg> legs) {
  BenchTool tool;
  tool.radius = kToolRadius;
  tool.start.p_W = start_W;
  tool.device = makeDevice(start_W, std::move(legs));
  return tool;
}

BenchBody makeBox(std::string name, double mass, const Vec3& p_W, const Vec3& half_extents) {
  BenchBody body;
  body.name = std::move(name);
  body.shape = BoxShape{half_extents};
  body.mass = mass;
  body.start.p_W = p_W;
  return body;
}

BenchBody makeCube(double mass, double z) {
  BenchBody cube = makeBox("cube", mass, {0, 0, z});
  cube.is_shared = true;
  return cube;
}

BenchBody makeWall(double x) { return makeBox("wall", 0.0, {x + 0.05, 0, 0}, {0.05, 0.2, 0.2}); }

BenchScene makeScene(std::string name, std::string title, double duration) {
  BenchScene scene;
  scene.name = std::move(name);
  scene.title = std::move(title);
  scene.duration = duration;
  return scene;
}

BenchScene makeFloorScene(std::string name, std::string title, double duration, double cube_mass,
                          double tool_height, std::vector<Leg> legs) {
  BenchScene scene = makeScene(std::move(name), std::move(title), duration);
  scene.gravity_W = kGravity;
  scene.friction = kFriction;
  scene.bodies = {makeFloor(), makeCube(cube_mass)};
  scene.tools = {makeTool({-kHalfCube - kToolRadius - 0.002, 0, tool_height}, std::move(legs))};
  return scene;
}

}  // namespace tandem::demos::bench
