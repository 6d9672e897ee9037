#include <algorithm>
#include <cmath>

#include "bench/scenes/bench_scene.h"

namespace tandem::demos::bench {
namespace {

constexpr double kHalfCube = 0.02;    // [m]
constexpr double kToolRadius = 0.01;  // [m]
constexpr double kFriction = 0.3;
const Vec3 kGravity{0, 0, -9.81};  // [m/s^2]

/// A part of a device's path: `way` from time `start` on, at constant speed except `ease` at each
/// end.
struct Leg {
  double start = 0.0;       // [s]
  double time = 1.0;        // [s]
  Vec3 way = Vec3::Zero();  // [m]
  double ease = 0.05;       // part of `time` for acceleration, and for braking
};

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

BenchTool makeTool(const Vec3& start_W, std::vector<Leg> legs) {
  BenchTool tool;
  tool.radius = kToolRadius;
  tool.start.p_W = start_W;
  tool.device = makeDevice(start_W, std::move(legs));
  return tool;
}

BenchBody makeBox(std::string name, double mass, const Vec3& p_W,
                  const Vec3& half_extents = Vec3::Constant(kHalfCube)) {
  BenchBody body;
  body.name = std::move(name);
  body.shape = BoxShape{half_extents};
  body.mass = mass;
  body.start.p_W = p_W;
  return body;
}

/// The cube that the tool pushes. Its lower face is at height 0 if `z` is its half edge.
BenchBody makeCube(double mass, double z = kHalfCube) {
  BenchBody cube = makeBox("cube", mass, {0, 0, z});
  cube.is_shared = true;
  return cube;
}

BenchBody makeFloor() {
  BenchBody floor;
  floor.name = "floor";
  floor.shape = PlaneShape{};
  return floor;
}

/// A wall whose near face is at `x`.
BenchBody makeWall(double x) { return makeBox("wall", 0.0, {x + 0.05, 0, 0}, {0.05, 0.2, 0.2}); }

BenchScene makeScene(std::string name, std::string title, double duration) {
  BenchScene scene;
  scene.name = std::move(name);
  scene.title = std::move(title);
  scene.duration = duration;
  return scene;
}

/// A scene on the floor, with a tool that starts 2 mm left of the cube's left face.
BenchScene makeFloorScene(std::string name, std::string title, double duration, double cube_mass,
                          double tool_height, std::vector<Leg> legs) {
  BenchScene scene = makeScene(std::move(name), std::move(title), duration);
  scene.gravity_W = kGravity;
  scene.friction = kFriction;
  scene.bodies = {makeFloor(), makeCube(cube_mass)};
  scene.tools = {makeTool({-kHalfCube - kToolRadius - 0.002, 0, tool_height}, std::move(legs))};
  return scene;
}

BenchScene makeLoneCoupler() {
  BenchScene scene = makeScene("lone_coupler", "lone coupler, released 10 mm off", 0.5);
  scene.is_smooth = true;
  BenchTool tool;
  tool.start.p_W = {0.01, 0, 0};
  tool.device = [](double) { return PointState{}; };
  scene.tools = {tool};
  return scene;
}

BenchScene makePress() {
  BenchScene scene = makeScene("press", "5 N press on a static cube", 0.3);
  scene.is_smooth = true;
  BenchTool tool;
  tool.radius = 0.02;
  tool.start.p_W = {-0.04, 0, 0};
  tool.f_W = {5, 0, 0};
  scene.tools = {tool};
  scene.bodies = {makeBox("cube", 0.0, Vec3::Zero())};
  return scene;
}

BenchScene makeImpact() {
  BenchScene scene = makeScene("impact", "impact at 0.5 m/s and rebound", 0.1);
  scene.is_smooth = true;
  BenchTool tool;
  tool.radius = 0.02;
  tool.start = {{-0.045, 0, 0}, {0.5, 0, 0}};
  scene.tools = {tool};
  scene.bodies = {makeBox("cube", 0.0, Vec3::Zero())};
  return scene;
}

BenchScene makeChain() {
  BenchScene scene = makeScene("chain", "device, cube and RDP in a chain", 1.0);
  scene.is_smooth = true;
  const double reach = kHalfCube + kToolRadius;
  scene.tools = {makeTool({-reach, 0, 0}, {{0.0, 0.25, {0.01, 0, 0}, 0.5},
                                           {0.4, 0.25, {-0.015, 0, 0}, 0.5},
                                           {0.65, 0.3, {0.01, 0, 0}, 0.5}}),
                 makeTool({reach, 0, 0}, {})};
  scene.bodies = {makeCube(0.1, 0.0)};
  return scene;
}

BenchScene makeCorner() {
  BenchScene scene = makeScene("corner", "tool round a box corner", 0.5);
  scene.is_smooth = true;
  scene.tools = {makeTool({-0.01, 0, kHalfCube + kToolRadius + 0.002},
                          {{0.0, 0.1, {0, 0, -0.007}, 0.5}, {0.1, 0.3, {0.06, 0, 0}, 0.2}})};
  scene.bodies = {makeBox("cube", 0.0, Vec3::Zero())};
  return scene;
}

BenchScene makeSphere() {
  BenchScene scene = makeScene("sphere", "tool over a sphere of 5 cm", 0.7);
  scene.is_smooth = true;
  BenchBody sphere;
  sphere.name = "sphere";
  sphere.shape = SphereShape{0.05};
  scene.tools = {makeTool({-0.06, 0, 0.055}, {{0.0, 0.6, {0.12, 0, 0}, 0.05}})};
  scene.bodies = {sphere};
  return scene;
}

/// Presses the cube against the wall with 25 N: 12.5 mm in the coupler and as much in the contact.
BenchScene makePushToWall() {
  BenchScene scene = makeFloorScene(
      "wall", "cube on a floor with friction, into a wall", 1.0, 0.25, 0.024,
      {{0.0, 0.5, {0.002 + 0.01 + 0.025, 0, 0}, 0.3}, {0.7, 0.25, {-0.03, 0, 0}, 0.3}});
  scene.bodies.push_back(makeWall(kHalfCube + 0.01));
  return scene;
}

BenchScene makeTipOverPost() {
  BenchScene scene = makeFloorScene("post", "cube tips over a low post", 0.8, 0.25, 0.032,
                                    {{0.0, 0.5, {0.03, 0, 0}, 0.2}});
  scene.bodies.push_back(
      makeBox("post", 0.0, {kHalfCube + 0.01 + 0.005, 0, 0.005}, {0.005, 0.1, 0.005}));
  return scene;
}

/// Without gravity, the cube hits a free box.
BenchScene makeFreeBox(std::string name, std::string title, double speed) {
  constexpr double kWay = 0.05;  // [m]
  const double time = kWay / speed / (1.0 - 0.1);
  BenchScene scene = makeScene(std::move(name), std::move(title), time + 0.1);
  scene.friction = kFriction;
  scene.bodies = {makeCube(0.1, 0.0), makeBox("box", 0.2, {2.0 * kHalfCube + 0.01, 0, 0})};
  scene.tools = {
      makeTool({-kHalfCube - kToolRadius - 0.002, 0, 0}, {{0.0, time, {kWay, 0, 0}, 0.1}})};
  return scene;
}

BenchScene makeRow() {
  BenchScene scene = makeFloorScene("row", "row of 3 boxes on the floor", 0.8, 0.1, kHalfCube,
                                    {{0.0, 0.6, {0.04, 0, 0}, 0.2}});
  for (int i = 1; i <= 3; ++i)
    scene.bodies.push_back(
        makeBox("box" + std::to_string(i), 0.2, {i * (2.0 * kHalfCube + 0.002), 0, kHalfCube}));
  return scene;
}

/// The tool holds 24.5 N.
BenchScene makeSqueeze() {
  BenchScene scene = makeFloorScene("squeeze", "box squeezed against a wall", 0.8, 0.1, kHalfCube,
                                    {{0.0, 0.5, {0.002 + 0.002 + 0.004 + 0.0245, 0, 0}, 0.2}});
  scene.bodies.push_back(makeBox("box", 0.2, {2.0 * kHalfCube + 0.002, 0, kHalfCube}));
  scene.bodies.push_back(makeWall(3.0 * kHalfCube + 0.002 + 0.004));
  return scene;
}

BenchScene makeStack() {
  BenchScene scene = makeFloorScene("stack", "cube into a stack of 4", 0.8, 0.1, kHalfCube,
                                    {{0.0, 0.7, {0.03, 0, 0}, 0.3}});
  for (int i = 0; i < 4; ++i)
    scene.bodies.push_back(makeBox("box" + std::to_string(i + 1), 0.2,
                                   {2.0 * kHalfCube + 0.003, 0, (2 * i + 1) * kHalfCube}));
  return scene;
}

std::vector<BenchScene> makeScenes() {
  return {makeLoneCoupler(),
          makePress(),
          makeImpact(),
          makeChain(),
          makeSphere(),
          makeCorner(),
          makePushToWall(),
          makeTipOverPost(),
          makeFreeBox("free_box", "free box met at 0.2 m/s", 0.2),
          makeFreeBox("free_box_fast", "free box met at 0.5 m/s", 0.5),
          makeRow(),
          makeSqueeze(),
          makeStack()};
}

}  // namespace

const std::vector<BenchScene>& allScenes() {
  static const std::vector<BenchScene> scenes = makeScenes();
  return scenes;
}

}  // namespace tandem::demos::bench
