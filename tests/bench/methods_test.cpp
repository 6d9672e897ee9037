// Every method that the bench compares, on scenes with a known closed form. An error in the bench
// is then the engine's, not that of our set-up. Engines not found when Tandem was configured are
// skipped.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "bench/methods/all_methods.h"
#include "bridge/bullet_rig.h"

namespace tandem::demos::bench {
namespace {

using test::byWidth;

constexpr int kRate = 1000;  // [Hz]
constexpr double kStep = 1.0 / kRate;
constexpr double kGravity = 9.81;  // [m/s^2]

/// A scene with a tool without a user only.
BenchScene makeScene(const Vec3& tool_W, double duration) {
  BenchScene scene;
  scene.name = "test";
  scene.duration = duration;
  scene.tools.resize(1);
  scene.tools[0].start.p_W = tool_W;
  return scene;
}

BenchBody makeCube(double mass, const Vec3& p_W) {
  BenchBody cube;
  cube.name = "cube";
  cube.mass = mass;
  cube.start.p_W = p_W;
  return cube;
}

class Methods : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    for (const auto& method : allMethods())
      if (method->name() == GetParam()) method_ = method.get();
    if (!method_) GTEST_SKIP() << GetParam() << " is not built in: its package is not installed";
  }

  /// True for scenes that a method cannot run, or treats like another method.
  [[nodiscard]] bool mayRefuse(const BenchScene& scene) const {
    if (!scene.joints.empty() && (is("MuJoCo") || is("Simbody"))) return true;
    if (is("Bullet 6DofSpring2") || is("Bullet Point2Point")) return !scene.tools[0].device;
    if (is("Bullet rigid")) return scene.bodies.empty();
    return is("Simbody") && !scene.is_smooth;
  }

  /// Final state of a scene; empty if the method cannot run it.
  std::optional<SceneState> run(const BenchScene& scene) const {
    SceneState state = startState(scene);
    try {
      const auto simulation = method_->start(scene, kRate);
      for (int i = 0; i < std::lround(scene.duration * kRate); ++i) simulation->step();
      simulation->read(state);
    } catch (const NotApplicable& why) {
      EXPECT_TRUE(mayRefuse(scene)) << why.what();
      return std::nullopt;
    }
    return state;
  }

  [[nodiscard]] bool is(std::string_view name) const { return name == GetParam(); }
  [[nodiscard]] bool isBullet() const { return std::string_view(GetParam()).starts_with("Bullet"); }
  /// Tolerance for rounding; the other engines use double.
  [[nodiscard]] double rounding(double if_double, double if_float) const {
    return isBullet() || is("force injection") || is("small Bullet world")
               ? byWidth(if_double, if_float)
               : if_double;
  }

  const Method* method_ = nullptr;
};

// Semi-implicit Euler falls g t h / 2 too far, an exact or high-order integrator not at all.
TEST_P(Methods, LetBodiesFall) {
  BenchScene scene = makeScene(Vec3(1, 0, 0), 0.2);
  scene.is_smooth = true;
  scene.gravity_W = Vec3(0, 0, -kGravity);
  scene.bodies = {makeCube(0.1, Vec3::Zero())};
  scene.bodies[0].start.v_W = Vec3(0.1, 0, 0);
  const auto end = run(scene);
  if (!end) return;
  const double t = scene.duration;
  EXPECT_NEAR(end->bodies[0].p_W.z(), -0.5 * kGravity * t * t, 0.51 * kGravity * t * kStep);
  EXPECT_NEAR(end->bodies[0].p_W.x(), 0.1 * t, rounding(1e-12, 1e-6));
  EXPECT_NEAR(end->bodies[0].v_W.z(), -kGravity * t, rounding(1e-9, 1e-5));
  EXPECT_EQ(end->tools[0].p_W, scene.tools[0].start.p_W);  // weightless, and untouched
}

// 5 N act on a tool that rests on a static cube: it sinks by 5 N / K. After half a second of B / 2m
// = 50/s, 1e-11 of the swing is left.
TEST_P(Methods, SinkByForceOverStiffness) {
  BenchScene scene = makeScene(Vec3(-0.03, 0, 0), 0.5);
  scene.is_smooth = true;
  scene.tools[0].f_W = Vec3(5, 0, 0);
  scene.bodies = {makeCube(0.0, Vec3::Zero())};
  const auto end = run(scene);
  if (!end) return;
  // Rigid contact sinks only by the overlap that it pushes out later.
  const double sink = is("Bullet rigid") ? 0.0 : 5.0 / scene.contact.stiffness;
  EXPECT_NEAR(end->tools[0].p_W.x(), -0.03 + sink, is("Bullet rigid") ? 1e-4 : 1e-6);
}

// A tool hits a free cube, centre on centre, and bounces off; no other body is there.
TEST_P(Methods, KeepMomentum) {
  BenchScene scene = makeScene(Vec3(-0.035, 0, 0), 0.2);
  scene.is_smooth = true;
  scene.tools[0].start.v_W = Vec3(0.3, 0, 0);
  scene.bodies = {makeCube(0.2, Vec3::Zero())};
  const auto end = run(scene);
  if (!end) return;
  const double before = scene.tools[0].mass * 0.3;
  const double after = scene.tools[0].mass * end->tools[0].v_W.x() + 0.2 * end->bodies[0].v_W.x();
  EXPECT_NEAR(after, before, rounding(1e-12, 1e-7));
  EXPECT_GT(end->bodies[0].v_W.x(), 0.09);  // they collided: together they would have 0.1 m/s
}

// A coupler alone: the closed form of a damped spring. All but Simbody are first order in the step.
TEST_P(Methods, SwingOnACoupler) {
  BenchScene scene = makeScene(Vec3(0.01, 0, 0), 0.05);
  scene.is_smooth = true;
  scene.tools[0].device = [](double) { return PointState{}; };
  const auto end = run(scene);
  if (!end) return;
  if (is("Bullet Point2Point")) {
    // The CFM is 8 at this step: the run diverges visibly.
    EXPECT_FALSE(end->tools[0].p_W.norm() < 1.0);
    return;
  }
  const double decay = 50.0, w = std::sqrt(2000.0 / 0.1 - decay * decay), t = scene.duration;
  const double x = 0.01 * std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t));
  EXPECT_NEAR(end->tools[0].p_W.x(), x, is("Simbody") ? 1e-8 : 0.65e-3);
}

// A cube slides on the floor until friction stops it: v^2 / (2 mu g). An engine's contact needs a
// few steps to carry the weight. Its friction then uses a force that is one step old.
TEST_P(Methods, SlideUntilFrictionStopsThem) {
  BenchScene scene = makeScene(Vec3(0, 0, 1), 0.5);
  scene.gravity_W = Vec3(0, 0, -kGravity);
  scene.friction = 0.3;
  BenchBody floor;
  floor.name = "floor";
  floor.shape = PlaneShape{};
  scene.bodies = {floor, makeCube(0.1, Vec3(0, 0, 0.02))};
  scene.bodies[1].start.v_W = Vec3(0.5, 0, 0);
  const auto end = run(scene);
  if (!end) return;
  const double way = 0.5 * 0.5 / (2.0 * scene.friction * kGravity);
  EXPECT_NEAR(end->bodies[1].p_W.x(), way, 0.03 * way);
  EXPECT_NEAR(end->bodies[1].p_W.y(), 0.0, 1e-4);
  EXPECT_NEAR(end->bodies[1].p_W.z(), 0.02, 1e-4);
  EXPECT_LT(end->bodies[1].v_W.norm(), 1e-3);
}

// A box of edges 40, 20 and 60 mm spins freely about its longest axis, a stable one.
TEST_P(Methods, SpinBodiesFreely) {
  BenchScene scene = makeScene(Vec3(1, 0, 0), 0.2);
  scene.is_smooth = true;
  scene.bodies = {makeCube(0.1, Vec3::Zero())};
  scene.bodies[0].shape = BoxShape{Vec3(0.02, 0.01, 0.03)};
  scene.bodies[0].start.w_W = Vec3(0, 0, 5);
  const auto end = run(scene);
  if (!end) return;
  const Quat expected(Eigen::AngleAxisd(5.0 * scene.duration, Vec3::UnitZ()));
  EXPECT_LT(end->bodies[0].q_WB.angularDistance(expected), rounding(1e-3, 1e-3));
}

/// A beam of 0.2 m and 0.5 kg along x, with its end at the origin.
BenchBody makeBeam() {
  BenchBody beam = makeCube(0.5, Vec3(0.1, 0, 0));
  beam.shape = BoxShape{Vec3(0.1, 0.02, 0.02)};
  return beam;
}

/// Moment of the beam about a hinge at its end [kg m^2].
const double kMomentAtEnd = computeInertia(makeBeam()).y() + 0.5 * 0.01;

// A beam falls from the horizontal onto the limit of its hinge, which has no bounce.
TEST_P(Methods, FallOnTheLimitOfAHinge) {
  BenchScene scene = makeScene(Vec3(1, 0, 0), 1.5);
  scene.gravity_W = Vec3(0, 0, -kGravity);
  scene.bodies = {makeBeam()};
  scene.joints.resize(1);
  scene.joints[0].limit = {-1.0, 0.5};
  const auto end = run(scene);
  if (!end) return;
  const Quat expected(Eigen::AngleAxisd(0.5, Vec3::UnitY()));
  EXPECT_LT(end->bodies[0].q_WB.angularDistance(expected), 5e-3);
  EXPECT_LT((end->bodies[0].p_W - expected * Vec3(0.1, 0, 0)).norm(), 1e-3);
  EXPECT_LT(end->bodies[0].w_W.norm(), 2e-2);
}

// A motor of 0.2 N m brings the beam to 2 rad/s in 2 J / 0.2 s, and keeps it there.
TEST_P(Methods, DriveAHinge) {
  constexpr double kSpeed = 2.0, kTorque = 0.2;
  BenchScene scene = makeScene(Vec3(1, 0, 0), 0.3);
  scene.bodies = {makeBeam()};
  scene.joints.resize(1);
  scene.joints[0].motor = {kSpeed, kTorque};
  const auto end = run(scene);
  if (!end) return;
  const double angle = kSpeed * (scene.duration - 0.5 * kSpeed * kMomentAtEnd / kTorque);
  const Quat expected(Eigen::AngleAxisd(angle, Vec3::UnitY()));
  EXPECT_LT(end->bodies[0].q_WB.angularDistance(expected), 1e-2);
  EXPECT_NEAR(end->bodies[0].w_W.y(), kSpeed, 1e-2);
}

// One body drives another along a slider, until their limit stops both. Nothing else holds them.
TEST_P(Methods, DriveASliderToItsLimit) {
  constexpr double kSpeed = 0.3, kForce = 2.0, kWay = 0.06;
  BenchScene scene = makeScene(Vec3(1, 0, 0), 0.15);
  scene.bodies = {makeCube(0.1, Vec3::Zero()), makeCube(0.2, Vec3(0.06, 0, 0))};
  scene.joints.resize(1);
  BenchJoint& slider = scene.joints[0];
  slider.kind = BenchJointKind::kSlider;
  slider.a = 1;
  slider.b = 0;
  slider.pivot_W = Vec3(0.03, 0, 0);
  slider.motor = {kSpeed, kForce};
  slider.limit = {-kWay, kWay};
  const auto before = run(scene);
  if (!before) return;
  const auto apart = [](const SceneState& state) {
    return (state.bodies[1].p_W - state.bodies[0].p_W).x() - 0.06;
  };
  // The motor moves the mass of both, one against the other.
  const double mass = 0.1 * 0.2 / 0.3;
  EXPECT_NEAR(apart(*before), kSpeed * (scene.duration - 0.5 * kSpeed * mass / kForce), 1e-3);
  EXPECT_NEAR((0.1 * before->bodies[0].v_W + 0.2 * before->bodies[1].v_W).norm(), 0.0,
              rounding(1e-9, 1e-6));
  scene.duration = 0.5;
  EXPECT_NEAR(apart(*run(scene)), kWay, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(All, Methods,
                         ::testing::Values("force injection", "small Bullet world", "Bullet rigid",
                                           "Bullet soft", "Bullet 6DofSpring2",
                                           "Bullet Point2Point", "MuJoCo", "ODE", "Simbody"),
                         [](const auto& named) {
                           std::string name = named.param;
                           std::erase_if(name, [](char c) { return std::isalnum(c) == 0; });
                           return name;
                         });

// Diverging numbers must be visible. No engine may restart, stop or exit silently.
TEST(EngineMethods, SayWhenTheyAreLost) {
  BenchScene scene = makeScene(Vec3(0.01, 0, 0), 1.0);
  scene.is_smooth = true;
  scene.coupler = {1e6, 0.0};  // w h = 19 at 60 Hz
  scene.tools[0].device = [](double) { return PointState{}; };
  for (const char* name : {"MuJoCo", "ODE", "Simbody"}) {
    for (const auto& method : allMethods()) {
      if (method->name() != name) continue;
      const auto simulation = method->start(scene, 60);
      for (int i = 0; i < 200; ++i) simulation->step();
      SceneState state = startState(scene);
      simulation->read(state);
      EXPECT_FALSE(state.tools[0].p_W.norm() < 1e6) << name;
    }
  }
}

}  // namespace
}  // namespace tandem::demos::bench
