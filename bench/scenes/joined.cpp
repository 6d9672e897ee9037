#include <cmath>

#include "bench/scenes/scene_parts.h"

namespace tandem::demos::bench {
namespace {

constexpr double kLink = 0.2, kHalfLink = 0.02;  // length of a link, half its thickness [m]

BenchBody makeLink() {
  BenchBody link = makeBox("link", 0.5, {0.5 * kLink, 0, 0}, {0.5 * kLink, kHalfLink, kHalfLink});
  link.is_shared = true;
  return link;
}

/// A hinge of body `a` with `b`, or with the world.
BenchJoint makeHinge(std::size_t a, std::optional<std::size_t> b, const Vec3& pivot_W) {
  BenchJoint hinge;
  hinge.a = a;
  hinge.b = b;
  hinge.pivot_W = pivot_W;
  return hinge;
}

/// Centre of a tool `gap` in front of a link that stands at `angle` about y, 15 cm from its hinge
/// at the origin. `side` is 1 on the side to which a positive turn moves it, else -1.
Vec3 placeAtLink(double angle, double side, double gap) {
  const Vec3 along(std::cos(angle), 0, -std::sin(angle)), ahead(along.z(), 0, -along.x());
  return 0.15 * along + side * (kHalfLink + kToolRadius + gap) * ahead;
}

/// The link falls from the horizontal and comes to the tool as it rises on the other side. There
/// the tool pushes it back, and leaves.
BenchScene makePendulum() {
  constexpr double kMet = 3.0;  // where the link meets the tool [rad]
  BenchScene scene = makeScene("pendulum", "pendulum pushed where it turns", 1.0);
  scene.gravity_W = kGravity;
  scene.bodies = {makeLink()};
  scene.joints = {makeHinge(0, std::nullopt, Vec3::Zero())};
  scene.tools = {makeTool(placeAtLink(kMet, 1.0, 0.0),
                          {{0.42, 0.12, {0, 0, -0.05}, 0.4}, {0.6, 0.2, {0, 0, 0.08}, 0.4}})};
  return scene;
}

/// Seen from above.
BenchScene makeDoor() {
  BenchScene scene = makeScene("door", "door pushed open", 1.0);
  scene.bodies = {makeBox("door", 2.0, {0.2, 0, 0}, {0.2, 0.1, 0.01})};
  scene.bodies[0].is_shared = true;
  scene.joints = {makeHinge(0, std::nullopt, Vec3::Zero())};
  scene.tools = {makeTool({0.35, 0, -0.01 - kToolRadius - 0.002},
                          {{0.0, 0.5, {0, 0, 0.1}, 0.3}, {0.5, 0.2, {0, 0, -0.05}, 0.4}})};
  return scene;
}

/// A chain hangs from the world. The tool pushes its last link to the side, and draws back.
BenchScene makeChain5() {
  constexpr int kCount = 5;
  constexpr double kLength = 0.1;  // of a link [m]
  BenchScene scene = makeScene("chain5", "last of five hanging links pushed", 1.0);
  scene.gravity_W = kGravity;
  for (int i = 0; i < kCount; ++i) {
    const auto index = static_cast<std::size_t>(i);
    scene.bodies.push_back(makeBox("link" + std::to_string(i + 1), 0.2,
                                   {0, 0, -(i + 0.5) * kLength}, {0.01, 0.01, 0.5 * kLength}));
    scene.joints.push_back(
        makeHinge(index, i > 0 ? std::optional(index - 1) : std::nullopt, {0, 0, -i * kLength}));
  }
  scene.bodies.back().is_shared = true;
  scene.tools = {makeTool({-0.01 - kToolRadius - 0.002, 0, -(kCount - 0.4) * kLength},
                          {{0.0, 0.3, {0.06, 0, 0}, 0.4}, {0.35, 0.2, {-0.06, 0, 0}, 0.4}})};
  return scene;
}

/// The link falls on the stop of its hinge. The tool lifts it off the stop, and lets it down again.
BenchScene makeStop() {
  constexpr double kStop = 0.5;  // [rad]
  BenchScene scene = makeScene("stop", "arm falls on its stop and is lifted", 1.0);
  scene.gravity_W = kGravity;
  scene.bodies = {makeLink()};
  scene.joints = {makeHinge(0, std::nullopt, Vec3::Zero())};
  scene.joints[0].limit = {-2.0, kStop};
  scene.tools = {makeTool(placeAtLink(kStop, 1.0, 0.005),
                          {{0.3, 0.25, {0, 0, 0.05}, 0.4}, {0.6, 0.15, {0, 0, -0.05}, 0.4}})};
  return scene;
}

/// A motor of 4 N drives a drawer against the tool, which gives way, and then pushes it back from
/// its limit.
BenchScene makeDrawer() {
  constexpr double kHalf = 0.05;  // [m]
  BenchScene scene = makeScene("drawer", "drawer with a motor, held back", 1.0);
  scene.gravity_W = kGravity;
  scene.bodies = {makeBox("drawer", 1.0, Vec3::Zero(), {kHalf, kHalf, 0.03})};
  scene.bodies[0].is_shared = true;
  BenchJoint slider;
  slider.kind = BenchJointKind::kSlider;
  slider.motor = {0.2, 4.0};
  slider.limit = {-0.05, 0.04};
  scene.joints = {slider};
  scene.tools = {makeTool({kHalf + kToolRadius + 0.02, 0, 0},
                          {{0.3, 0.2, {0.03, 0, 0}, 0.3}, {0.6, 0.3, {-0.06, 0, 0}, 0.4}})};
  return scene;
}

}  // namespace

std::vector<BenchScene> makeJoined() {
  return {makePendulum(), makeDoor(), makeChain5(), makeStop(), makeDrawer()};
}

}  // namespace tandem::demos::bench
