#include "bench/scenes/scene_parts.h"

namespace tandem::demos::bench {
namespace {

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
  std::vector<BenchScene> scenes = {makeLoneCoupler(),
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
  for (auto* make : {makePiles, makeJoined})
    for (BenchScene& scene : make()) scenes.push_back(std::move(scene));
  return scenes;
}

}  // namespace

const std::vector<BenchScene>& allScenes() {
  static const std::vector<BenchScene> scenes = makeScenes();
  return scenes;
}

}  // namespace tandem::demos::bench
