// The planar rigid solver against closed forms. Contacts make it first order. Tolerances are the
// error of a step of 1/96 ms: h times a speed, or h^2 times an acceleration.

#include "bench/reference/planar_solver.h"

#include <cmath>

#include <gtest/gtest.h>

namespace tandem::demos::bench {
namespace {

constexpr double kStep = 1.0 / 96000.0;  // [s]
constexpr double kGravity = 9.81;        // [m/s^2]

PlanarBody makeFloor(double slope = 0.0) {
  PlanarBody floor;
  floor.shape = PlanarShape::kHalfPlane;
  floor.normal = {-std::sin(slope), std::cos(slope)};
  return floor;
}

PlanarBody makeBox(const Vec2& half, double mass, const Vec2& p, double angle = 0.0) {
  PlanarBody box;
  box.half = half;
  box.mass = mass;
  box.inertia = mass / 3.0 * half.squaredNorm();
  box.p = p;
  box.angle = angle;
  return box;
}

void run(PlanarSolver& solver, double duration) {
  const auto steps = static_cast<int>(std::lround(duration / kStep));
  for (int i = 0; i < steps; ++i) solver.step(kStep);
}

PlanarScene makeScene(double friction) {
  PlanarScene scene;
  scene.gravity = {0.0, -kGravity};
  scene.friction = friction;
  return scene;
}

TEST(PlanarSolver, FallsFreely) {
  PlanarScene scene = makeScene(0.0);
  scene.bodies = {makeBox({0.02, 0.02}, 0.1, {0, 1})};
  scene.bodies[0].w = 2.0;
  PlanarSolver solver(scene);
  run(solver, 0.25);
  // Leap-frog is exact for a constant force.
  EXPECT_NEAR(solver.scene().bodies[0].p.y(), 1.0 - 0.5 * kGravity * 0.0625, 1e-12);
  EXPECT_NEAR(solver.scene().bodies[0].angle, 0.5, 1e-12);
}

TEST(PlanarSolver, BlockSlidesToItsStopAndStays) {
  constexpr double kSpeed = 0.5, kFriction = 0.3;
  PlanarScene scene = makeScene(kFriction);
  scene.bodies = {makeFloor(), makeBox({0.02, 0.02}, 0.2, {0, 0.02})};
  scene.bodies[1].v = {kSpeed, 0.0};
  PlanarSolver solver(scene);
  run(solver, 0.5);  // it stops after v / (mu g) = 0.17 s
  const double way = kSpeed * kSpeed / (2.0 * kFriction * kGravity);
  EXPECT_NEAR(solver.scene().bodies[1].p.x(), way, kSpeed * kStep);
  EXPECT_NEAR(solver.scene().bodies[1].p.y(), 0.02, 1e-9);
  const double stopped_at = solver.scene().bodies[1].p.x();
  run(solver, 0.5);
  EXPECT_NEAR(solver.scene().bodies[1].p.x(), stopped_at, 1e-9);
}

TEST(PlanarSolver, BlockOnASlopeSticksOrSlides) {
  constexpr double kFriction = 0.3;
  for (const double slope : {0.25, 0.35}) {  // atan(0.3) = 0.291
    PlanarScene scene = makeScene(kFriction);
    const PlanarBody floor = makeFloor(slope);
    scene.bodies = {floor, makeBox({0.02, 0.02}, 0.2, 0.02 * floor.normal, slope)};
    PlanarSolver solver(scene);
    run(solver, 0.2);
    const double pull = kGravity * (std::sin(slope) - kFriction * std::cos(slope));
    const double way = pull > 0.0 ? 0.5 * pull * 0.04 : 0.0;
    const double moved = (solver.scene().bodies[1].p - 0.02 * floor.normal).norm();
    EXPECT_NEAR(moved, way, 2.0 * kStep * 0.2) << slope;
  }
}

TEST(PlanarSolver, RestingBoxPressesWithItsWeight) {
  PlanarScene scene = makeScene(0.3);
  scene.bodies = {makeFloor(), makeBox({0.02, 0.02}, 0.2, {0, 0.02}),
                  makeBox({0.02, 0.02}, 0.3, {0.005, 0.06})};
  PlanarSolver solver(scene);
  run(solver, 0.1);
  EXPECT_NEAR(solver.normalImpulse(0, 1), 0.5 * kGravity * kStep, 1e-9 * kStep);
  EXPECT_NEAR(solver.normalImpulse(1, 2), 0.3 * kGravity * kStep, 1e-9 * kStep);
}

// A push F at height z tips a box (weight m g, half width a) if F z > m g a.
TEST(PlanarSolver, BoxTipsWhenThePushIsStrongEnough) {
  constexpr double kMass = 0.2, kHalf = 0.02, kHeight = 0.03;
  const double limit = kMass * kGravity * kHalf / kHeight;
  for (const double share : {0.97, 1.03}) {
    PlanarScene scene = makeScene(2.0);
    scene.contact_stiffness = 2000.0;
    scene.contact_damping = 20.0;
    scene.bodies = {makeFloor(), makeBox({kHalf, kHalf}, kMass, {0, kHalf})};
    PlanarTool tool;
    tool.force = {share * limit, 0.0};
    // The tool already pushes with its full force, so nothing swings.
    tool.p = {-kHalf - tool.radius + tool.force.x() / 2000.0, kHeight};
    scene.tools = {tool};
    PlanarSolver solver(scene);
    run(solver, 0.1);
    const double angle = solver.scene().bodies[1].angle;
    if (share < 1.0) {
      EXPECT_NEAR(angle, 0.0, 1e-9);
    } else {
      EXPECT_LT(angle, -1e-3);
    }
  }
}

// A box that stands on a corner falls as a pendulum about it: (J + m r^2) a'' = m g r sin a, with a
// from the vertical.
TEST(PlanarSolver, BoxTurnsAboutItsCornerAsAPendulum) {
  constexpr double kMass = 0.2;
  const Vec2 half(0.015, 0.03);
  const double r = half.norm();
  const double inertia = kMass / 3.0 * half.squaredNorm() + kMass * r * r;
  double a = -0.2, rate = 0.0;  // leans left of upright over its lower left corner
  const double upright =
      std::atan2(half.y(), half.x());  // angle of the diagonal from the lower edge

  PlanarScene scene = makeScene(50.0);
  const double angle = 0.5 * std::acos(-1.0) - a - upright;
  const Vec2 diagonal(std::sin(a), std::cos(a));
  scene.bodies = {makeFloor(), makeBox(half, kMass, r * diagonal, angle)};
  PlanarSolver solver(scene);

  constexpr double kDuration = 0.08;
  run(solver, kDuration);
  constexpr int kFine = 20000;  // Runge-Kutta 4 steps
  const auto pull = [&](double x) { return kMass * kGravity * r * std::sin(x) / inertia; };
  const double h = kDuration / kFine;
  for (int i = 0; i < kFine; ++i) {
    const double k1 = pull(a), k2 = pull(a + 0.5 * h * rate),
                 k3 = pull(a + 0.5 * h * rate + 0.25 * h * h * k1),
                 k4 = pull(a + h * rate + 0.5 * h * h * k2);
    a += h * rate + h * h / 6.0 * (k1 + k2 + k3);
    rate += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  EXPECT_GT(std::abs(a + 0.2), 0.05);  // it has moved
  const Vec2 expected(r * std::sin(a), r * std::cos(a));
  EXPECT_NEAR((solver.scene().bodies[1].p - expected).norm(), 0.0, 2e-6);
  EXPECT_NEAR(solver.scene().bodies[1].angle, angle - (a + 0.2), 1e-4);
}

TEST(PlanarSolver, BoxesThatMeetGoOnTogether) {
  PlanarScene scene;
  scene.bodies = {makeBox({0.02, 0.02}, 0.1, {0, 0}), makeBox({0.02, 0.02}, 0.3, {0.05, 0})};
  scene.bodies[0].v = {0.4, 0.0};
  PlanarSolver solver(scene);
  run(solver, 0.2);
  const PlanarBody& a = solver.scene().bodies[0];
  const PlanarBody& b = solver.scene().bodies[1];
  EXPECT_NEAR(a.v.x(), 0.1, 1e-12);  // restitution 0: one common speed, momentum conserved
  EXPECT_NEAR(b.v.x(), 0.1, 1e-12);
  EXPECT_NEAR(b.p.x() - a.p.x(), 0.04, 1e-9);  // no overlap
  EXPECT_NEAR(b.p.x(), 0.05 + 0.1 * (0.2 - 0.01 / 0.4), 0.4 * kStep);
}

// A box falls on a fixed bump at distance d from its centre. The point of impact stops: j = m v /
// (1 + m d^2 / J). The box turns at j d / J.
TEST(PlanarSolver, OffCentreImpactTurnsTheBox) {
  constexpr double kMass = 0.2, kSpeed = 0.3, kArm = 0.012;
  PlanarScene scene;
  PlanarBody bump;
  bump.shape = PlanarShape::kCircle;
  bump.radius = 0.005;
  bump.p = {kArm, -0.005};
  scene.bodies = {bump, makeBox({0.02, 0.02}, kMass, {0, 0.021})};
  scene.bodies[1].v = {0.0, -kSpeed};
  PlanarSolver solver(scene);
  run(solver, 0.0036);  // just after the impact at 1 mm / 0.3 m/s
  const double inertia = scene.bodies[1].inertia;
  const double impulse = kMass * kSpeed / (1.0 + kMass * kArm * kArm / inertia);
  // Since the impact the box has rolled on the bump for less than 0.3 ms, at w^2 d < 1 m/s^2.
  EXPECT_NEAR(solver.scene().bodies[1].w, impulse * kArm / inertia, 0.02);
  EXPECT_NEAR(solver.scene().bodies[1].v.y(), -kSpeed + impulse / kMass, 4e-4);
}

}  // namespace
}  // namespace tandem::demos::bench
