// Joints of the planar solver against closed forms and equations of motion in angles, which have no
// joints to hold.

#include "bench/reference/planar_joints.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "bench/reference/planar_solver.h"

namespace tandem::demos::bench {
namespace {

constexpr double kStep = 1.0 / 96000.0;       // [s]
constexpr double kGravity = 9.81;             // [m/s^2]
constexpr double kLength = 0.2, kMass = 0.5;  // of a link [m], [kg]
constexpr double kWidth = 0.04;               // [m]
constexpr double kMoment = kMass / 12.0 * (kLength * kLength + kWidth * kWidth);  // [kg m^2]
const double kPi = std::acos(-1.0);

/// Links along x from the origin, each joined to the one before.
PlanarScene makeLinks(int count) {
  PlanarScene scene;
  scene.gravity = {0.0, -kGravity};
  for (int i = 0; i < count; ++i) {
    PlanarBody link;
    link.half = {0.5 * kLength, 0.5 * kWidth};
    link.mass = kMass;
    link.inertia = kMoment;
    link.p = {kLength * (i + 0.5), 0.0};
    scene.bodies.push_back(link);
    PlanarJoint hinge;
    hinge.a = static_cast<std::size_t>(i);
    hinge.at_a = {-0.5 * kLength, 0.0};
    if (i > 0) {
      hinge.b = static_cast<std::size_t>(i - 1);
      hinge.at_b = {0.5 * kLength, 0.0};
    }
    scene.joints.push_back(hinge);
  }
  return scene;
}

void run(PlanarSolver& solver, double duration, double step = kStep) {
  const auto steps = static_cast<int>(std::lround(duration / step));
  for (int i = 0; i < steps; ++i) solver.step(step);
}

/// Largest distance of a joint's two points, over a scene of hinges [m].
double computeGap(const PlanarScene& scene) {
  double largest = 0.0;
  for (const PlanarJoint& joint : scene.joints) {
    const auto place = [](const PlanarBody& body, const Vec2& at) {
      return Vec2(body.p + std::cos(body.angle) * at + std::sin(body.angle) * turnQuarter(at));
    };
    const Vec2 b = joint.b ? place(scene.bodies[*joint.b], joint.at_b) : joint.at_b;
    largest = std::max(largest, (place(scene.bodies[joint.a], joint.at_a) - b).norm());
  }
  return largest;
}

/// Angles of links and their rates, by Runge-Kutta's method of order 4 in steps of 1 us.
template <std::size_t kCount, typename Accelerate>
std::array<double, 2 * kCount> integrate(double duration, Accelerate accelerate) {
  using State = std::array<double, 2 * kCount>;
  const auto rates = [&](const State& x) {
    State dx;
    const auto a = accelerate(x);
    for (std::size_t i = 0; i < kCount; ++i) {
      dx[i] = x[kCount + i];
      dx[kCount + i] = a[i];
    }
    return dx;
  };
  const auto plus = [](const State& x, double h, const State& dx) {
    State sum = x;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += h * dx[i];
    return sum;
  };
  State x{};
  const auto steps = static_cast<int>(std::lround(duration * 1e6));
  const double h = duration / steps;
  for (int n = 0; n < steps; ++n) {
    const State k1 = rates(x), k2 = rates(plus(x, 0.5 * h, k1));
    const State k3 = rates(plus(x, 0.5 * h, k2)), k4 = rates(plus(x, h, k3));
    for (std::size_t i = 0; i < x.size(); ++i)
      x[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
  }
  return x;
}

constexpr double kMomentAtPin = kMoment + 0.25 * kMass * kLength * kLength;

/// A link that falls from the horizontal: its angle and rate.
std::array<double, 2> fall(double duration) {
  return integrate<1>(duration, [](const std::array<double, 2>& x) {
    return std::array{-0.5 * kMass * kGravity * kLength * std::cos(x[0]) / kMomentAtPin};
  });
}

// A pendulum of amplitude A swings to the other side in half of 4 sqrt(J / (m g d)) K(sin(A / 2)).
TEST(PlanarJoints, APendulumTakesTheTimeOfTheEllipticIntegral) {
  const double half = 2.0 * std::sqrt(kMomentAtPin / (kMass * kGravity * 0.5 * kLength)) *
                      std::comp_ellint_1(std::sin(0.25 * kPi));
  for (const double step : {1.0 / 12000.0, 1.0 / 24000.0}) {
    PlanarSolver solver(makeLinks(1));
    double before = 0.0;
    // It stands still there: its rate changes sign.
    double crossed = 0.0;
    for (int n = 1; crossed == 0.0 && n * step < 1.0; ++n) {
      before = solver.scene().bodies[0].w;
      solver.step(step);
      const double now = solver.scene().bodies[0].w;
      if (before < 0.0 && now >= 0.0) crossed = step * (n - 1 + before / (before - now));
    }
    // Order 2: w h = 7e-4 at 12 kHz.
    EXPECT_NEAR(crossed, half, half * 0.2 * std::pow(8.6 * step, 2)) << step;
    EXPECT_NEAR(solver.scene().bodies[0].angle, -kPi, 1e-6);
  }
}

// Order 2: at most 12 rad/s times h makes 1.6e-8 of the angle's change by the end.
TEST(PlanarJoints, APendulumSwingsAsItsEquationOfMotion) {
  for (const double duration : {0.2, 1.0, 2.0}) {
    PlanarSolver solver(makeLinks(1));
    run(solver, duration);
    const auto [angle, rate] = fall(duration);
    EXPECT_NEAR(solver.scene().bodies[0].angle, angle, 1e-7);
    EXPECT_NEAR(solver.scene().bodies[0].w, rate, 1e-6);
    EXPECT_LT(computeGap(solver.scene()), 1e-14);
  }
}

/// Accelerations of two links on each other, from Lagrange's equations in their angles.
std::array<double, 2> accelerateTwo(const std::array<double, 4>& x) {
  const auto [a, b, u, v] = x;
  const double c = 0.5 * kMass * kLength * kLength;
  const double m11 = kMomentAtPin + kMass * kLength * kLength, m22 = kMomentAtPin;
  const double m12 = c * std::cos(a - b), s = c * std::sin(a - b);
  const double f1 = -s * v * v - 1.5 * kMass * kGravity * kLength * std::cos(a);
  const double f2 = s * u * u - 0.5 * kMass * kGravity * kLength * std::cos(b);
  const double determinant = m11 * m22 - m12 * m12;
  return {(m22 * f1 - m12 * f2) / determinant, (m11 * f2 - m12 * f1) / determinant};
}

// Order 2: half of the step has a quarter of the error.
TEST(PlanarJoints, TwoLinksSwingAsTheirEquationsOfMotion) {
  const auto truth = integrate<2>(1.0, accelerateTwo);
  std::array<double, 2> errors{};
  for (std::size_t i = 0; i < 2; ++i) {
    PlanarSolver solver(makeLinks(2));
    run(solver, 1.0, i == 0 ? 2.0 * kStep : kStep);
    const auto& bodies = solver.scene().bodies;
    errors[i] = std::hypot(bodies[0].angle - truth[0], bodies[1].angle - truth[1]);
    EXPECT_LT(computeGap(solver.scene()), 1e-14);
  }
  EXPECT_LT(errors[1], 1e-7);
  EXPECT_NEAR(errors[0] / errors[1], 4.0, 0.4);
}

// A limit takes all speed in the step that reaches it.
TEST(PlanarJoints, AnArmRestsOnItsLimit) {
  PlanarScene scene = makeLinks(1);
  scene.joints[0].limit = {-0.5, 2.0};
  PlanarSolver solver(scene);
  double least = 0.0;
  for (int n = 0; n < 48000; ++n) {
    solver.step(kStep);
    least = std::min(least, PlanarJoints::computeCoordinate(solver.scene(), scene.joints[0]));
  }
  EXPECT_NEAR(least, -0.5, 1e-9);
  EXPECT_NEAR(solver.scene().bodies[0].angle, -0.5, 1e-9);
  EXPECT_LT(computeGap(solver.scene()), 1e-14);
}

// A motor of 5 N brings 0.5 kg to 0.7 m/s in 0.07 s, along an axis that rises by 30 degrees.
TEST(PlanarJoints, AMotorDrivesADrawer) {
  constexpr double kSpeed = 0.7, kForce = 5.0, kTime = 0.2;
  PlanarScene scene = makeLinks(1);
  scene.gravity = Vec2::Zero();
  PlanarJoint& slider = scene.joints[0];
  slider.is_slider = true;
  slider.at_b = {0.0, 0.0};
  slider.axis = {std::cos(kPi / 6.0), std::sin(kPi / 6.0)};
  slider.motor = {kSpeed, kForce};
  const Vec2 axis = slider.axis, start = scene.bodies[0].p;
  PlanarSolver solver(scene);
  run(solver, kTime);
  const double way = kSpeed * (kTime - 0.5 * kSpeed * kMass / kForce);
  const PlanarBody& drawer = solver.scene().bodies[0];
  EXPECT_LT((drawer.p - start - way * axis).norm(), 2.0 * kSpeed * kStep);
  EXPECT_LT((drawer.v - kSpeed * axis).norm(), 1e-9);
  EXPECT_NEAR(drawer.angle, 0.0, 1e-14);
}

// Two bodies on a slider in space: their momenta stay, and each drives the other.
TEST(PlanarJoints, ASliderBetweenTwoKeepsTheirMomenta) {
  PlanarScene scene = makeLinks(2);
  scene.gravity = Vec2::Zero();
  scene.joints.erase(scene.joints.begin());
  PlanarJoint& slider = scene.joints[0];
  slider.is_slider = true;
  slider.limit = {-0.1, 0.1};
  slider.motor = {0.3, 2.0};
  scene.bodies[0].w = scene.bodies[1].w = 3.0;
  scene.bodies[1].v = {0.0, 3.0 * kLength};
  const auto momentum = [](const PlanarScene& now) {
    Vec2 linear = Vec2::Zero();
    double angular = 0.0;
    for (const PlanarBody& body : now.bodies) {
      linear += kMass * body.v;
      angular += kMass * cross(body.p, body.v) + kMoment * body.w;
    }
    return Eigen::Vector3d(linear.x(), linear.y(), angular);
  };
  const Eigen::Vector3d before = momentum(scene);
  PlanarSolver solver(scene);
  run(solver, 1.0);
  EXPECT_LT((momentum(solver.scene()) - before).norm(), 1e-6);
  EXPECT_NEAR(PlanarJoints::computeCoordinate(solver.scene(), slider), 0.1, 1e-6);
}

}  // namespace
}  // namespace tandem::demos::bench
