#include "bench/scenes/scene_parts.h"

namespace tandem::demos::bench {
namespace {

/// The boxes have gaps of 1 mm. Their friction alone is 9.4 N.
BenchScene makeRow16() {
  constexpr double kGap = 0.001;  // [m]
  BenchScene scene = makeFloorScene("row16", "row of 16 boxes on the floor", 1.0, 0.1, kHalfCube,
                                    {{0.0, 0.85, {0.045, 0, 0}, 0.3}});
  for (int i = 1; i <= 16; ++i)
    scene.bodies.push_back(
        makeBox("box" + std::to_string(i), 0.2, {i * (2.0 * kHalfCube + kGap), 0, kHalfCube}));
  return scene;
}

/// A tower of cubes of 0.1 kg on the cube. The device moves for `time` [s], and `way` [m] beyond
/// what friction presses coupler and contact in. An even acceleration of g / blocks would tip the
/// tower.
BenchScene makeTower(int blocks, double duration, double time, double way) {
  constexpr double kMass = 0.1;  // [kg]
  const double pressed = kFriction * blocks * kMass * 9.81 / 1000.0;
  const std::string count = std::to_string(blocks);
  BenchScene scene =
      makeFloorScene("tower" + count, "tower of " + count + " blocks, pushed at its foot", duration,
                     kMass, kHalfCube, {{0.0, time, {0.002 + pressed + way, 0, 0}, 0.5}});
  for (int i = 1; i < blocks; ++i)
    scene.bodies.push_back(
        makeBox("block" + std::to_string(i), kMass, {0, 0, (2 * i + 1) * kHalfCube}));
  return scene;
}

/// The box weighs 25 times as much as the cube under it. Friction is 15.3 N.
BenchScene makeHeavy() {
  constexpr double kHalfBox = 0.03;  // [m]
  BenchScene scene = makeFloorScene("heavy", "cube under a box of 5 kg", 1.0, 0.2, kHalfCube,
                                    {{0.0, 0.9, {0.032, 0, 0}, 0.5}});
  scene.bodies.push_back(
      makeBox("box", 5.0, {0, 0, 2.0 * kHalfCube + kHalfBox}, Vec3::Constant(kHalfBox)));
  return scene;
}

/// The cube is put on a belt, on which a box comes behind it. The belt carries both to the tool,
/// which holds them, pushes them back and lets go.
BenchScene makeConveyor() {
  BenchScene scene = makeScene("conveyor", "belt carries two boxes to the tool", 1.0);
  scene.gravity_W = kGravity;
  scene.friction = kFriction;
  BenchBody belt = makeBox("belt", 0.0, {0, 0, -0.02}, {0.5, 0.1, 0.02});
  belt.start.v_W = {0.1, 0, 0};
  scene.bodies = {belt, makeCube(0.25), makeBox("box", 0.2, {-0.06, 0, kHalfCube})};
  scene.bodies[2].start.v_W = belt.start.v_W;
  scene.tools = {makeTool({kHalfCube + kToolRadius + 0.012, 0, kHalfCube},
                          {{0.4, 0.25, {-0.02, 0, 0}, 0.4}, {0.75, 0.2, {0.04, 0, 0}, 0.4}})};
  return scene;
}

}  // namespace

std::vector<BenchScene> makePiles() {
  return {makeRow16(), makeTower(9, 1.2, 1.1, 0.009), makeTower(18, 1.1, 1.4, 0.006), makeHeavy(),
          makeConveyor()};
}

}  // namespace tandem::demos::bench
