// The references of the benchmarks against closed forms, each other and themselves.

#include <cmath>

#include <gtest/gtest.h>

#include "bench/reference/planar_reference.h"
#include "bench/reference/smooth_reference.h"
#include "bench/scenes/touch_geometry.h"

namespace tandem::demos::bench {
namespace {

constexpr double kMaxStep = 1.0 / kGridRate;

const BenchScene& findScene(const std::string& name) {
  for (const BenchScene& scene : allScenes())
    if (scene.name == name) return scene;
  throw std::invalid_argument(name);
}

double timeOf(std::size_t n) { return static_cast<double>(n) / kGridRate; }

/// A mass on a spring-damper about its rest, released at x0 with speed v0.
double swing(double stiffness, double damping, double mass, double x0, double v0, double t) {
  const double decay = 0.5 * damping / mass;
  const double w = std::sqrt(stiffness / mass - decay * decay);
  return std::exp(-decay * t) * (x0 * std::cos(w * t) + (v0 + decay * x0) / w * std::sin(w * t));
}

TEST(SmoothReference, LoneCouplerIsADampedSwing) {
  const BenchScene& scene = findScene("lone_coupler");
  const ReferenceRun run = runSmoothReference(scene, kMaxStep);
  ASSERT_EQ(run.states.size(), 6001u);
  for (std::size_t n = 0; n < run.states.size(); ++n)
    ASSERT_NEAR(run.states[n].tools[0].p_W.x(), swing(2000, 10, 0.1, 0.01, 0, timeOf(n)), 1e-13);
}

TEST(SmoothReference, PressIsADampedSwingAboutItsRest) {
  const ReferenceRun run = runSmoothReference(findScene("press"), kMaxStep);
  const double rest = -0.04 + 5.0 / 2000.0;
  for (std::size_t n = 0; n < run.states.size(); ++n)
    ASSERT_NEAR(run.states[n].tools[0].p_W.x(),
                rest + swing(2000, 10, 0.1, -5.0 / 2000.0, 0, timeOf(n)), 1e-12);
}

// Without damping the contact is half a swing of time pi / w, and returns the full speed.
TEST(SmoothReference, UndampedImpactGivesTheSpeedBack) {
  BenchScene scene = findScene("impact");
  scene.contact.damping = 0.0;
  const ReferenceRun run = runSmoothReference(scene, kMaxStep);
  const double begin = 0.005 / 0.5;
  const double end = begin + std::acos(-1.0) / std::sqrt(2000.0 / 0.1);
  for (std::size_t n = 0; n < run.states.size(); ++n) {
    const double t = timeOf(n);
    double x = -0.04;
    if (t < begin) {
      x += 0.5 * (t - begin);
    } else if (t < end) {
      x += swing(2000, 0, 0.1, 0, 0.5, t - begin);
    } else {
      x -= 0.5 * (t - end);
    }
    ASSERT_NEAR(run.states[n].tools[0].p_W.x(), x, 1e-12) << t;
  }
}

TEST(SmoothReference, RefusesToTurnABody) {
  BenchScene scene = findScene("chain");
  scene.tools[0].start.p_W.z() = 0.005;
  scene.tools[0].start.p_W.x() += 0.001;
  EXPECT_THROW((void)runSmoothReference(scene, kMaxStep), std::invalid_argument);
}

double difference(const BenchScene& scene, const ReferenceRun& a, const ReferenceRun& b) {
  double largest = 0.0;
  for (std::size_t n = 0; n < a.states.size(); ++n) {
    for (std::size_t i = 0; i < scene.tools.size(); ++i)
      largest = std::max(largest, (a.states[n].tools[i].p_W - b.states[n].tools[i].p_W).norm());
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      largest = std::max(largest, (a.states[n].bodies[i].p_W - b.states[n].bodies[i].p_W).norm());
  }
  return largest;
}

class SmoothScene : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, SmoothScene,
                         ::testing::Values("lone_coupler", "press", "impact", "chain", "sphere",
                                           "corner"),
                         [](const auto& one) { return std::string(one.param); });

// Two solvers that share only the scene. The planar one misses the moment of a touch by up to a
// step h. At 0.5 m/s the damper's force is then missing for h: B v h / m = 0.5 mm/s. In the 70 ms
// after the impact that is at most 35 um.
TEST_P(SmoothScene, BothReferencesAgree) {
  const BenchScene& scene = findScene(GetParam());
  const ReferenceRun exact = runSmoothReference(scene, kMaxStep);
  EXPECT_LT(difference(scene, exact, runPlanarReference(scene, 96000)), 1e-5);
}

TEST_P(SmoothScene, HalvingTheStepChangesNothing) {
  const BenchScene& scene = findScene(GetParam());
  EXPECT_LT(difference(scene, runSmoothReference(scene, kMaxStep),
                       runSmoothReference(scene, 0.5 * kMaxStep)),
            1e-9);
}

class RigidScene : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, RigidScene,
                         ::testing::Values("wall", "post", "free_box", "free_box_fast", "row",
                                           "squeeze", "stack", "row16", "tower9", "heavy",
                                           "conveyor"),
                         [](const auto& one) { return std::string(one.param); });

// Order one: at 24 kHz and twice as fine, the difference is at most 20 um, and further refinement
// reduces it. The benchmark's table shows the error at its own step.
TEST_P(RigidScene, PlanarReferenceConverges) {
  const BenchScene& scene = findScene(GetParam());
  const ReferenceRun coarse = runPlanarReference(scene, 24000);
  const ReferenceRun middle = runPlanarReference(scene, 48000);
  // Piles take the solver most of a minute at 192 kHz.
  const ReferenceRun fine = runPlanarReference(scene, scene.bodies.size() > 6 ? 96000 : 192000);
  EXPECT_LT(difference(scene, coarse, middle), 2e-5);
  EXPECT_LT(difference(scene, middle, fine), 1e-5);
}

class JointScene : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, JointScene,
                         ::testing::Values("pendulum", "door", "chain5", "stop", "drawer"),
                         [](const auto& one) { return std::string(one.param); });

// Order one where a tool or a limit is met, order two between.
TEST_P(JointScene, PlanarReferenceConverges) {
  const BenchScene& scene = findScene(GetParam());
  const ReferenceRun coarse = runPlanarReference(scene, 24000);
  const ReferenceRun middle = runPlanarReference(scene, 48000);
  EXPECT_LT(difference(scene, coarse, middle), 1e-5);
  EXPECT_LT(difference(scene, middle, runPlanarReference(scene, 192000)), 5e-6);
}

// They are about what their names say: the tool meets a body, and a limit is reached.
TEST_P(JointScene, ToolsMeetABodyAndLimitsAreReached) {
  const BenchScene& scene = findScene(GetParam());
  const ReferenceRun run = runPlanarReference(scene, 24000);
  const BenchJoint& joint = scene.joints[0];
  double pushed = 0.0, nearest = HUGE_VAL;
  for (const SceneState& state : run.states) {
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
      pushed = std::max(pushed, computeTouch(scene.bodies[b], state.bodies[b], state.tools[0].p_W,
                                             scene.tools[0].radius)
                                    .overlap);
    if (!joint.limit) continue;
    const RigidState& a = state.bodies[joint.a];
    const double at =
        joint.kind == BenchJointKind::kHinge ? 2.0 * std::atan2(a.q_WB.y(), a.q_WB.w()) : a.p_W.x();
    nearest = std::min(nearest, joint.limit->high - at);
  }
  EXPECT_GT(pushed, 5e-4);  // 1 N
  if (joint.limit) {
    EXPECT_NEAR(nearest, 0.0, 1e-9);
  }
}

}  // namespace
}  // namespace tandem::demos::bench
