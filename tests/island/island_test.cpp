#include "coordination/src/island/island.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace tandem {
namespace {

constexpr double kPeriod = 1e-3;  // haptic period [s]

IslandBody makeBall(double mass, const Vec3& p_W = Vec3::Zero(), const Vec3& v_W = Vec3::Zero()) {
  IslandBody ball;
  ball.shape = Sphere{0.01};
  ball.mass = mass;
  ball.start.p_W = p_W;
  ball.start.v_W = v_W;
  return ball;
}

IslandBody makeCube(double mass, double edge, const Vec3& p_W = Vec3::Zero()) {
  IslandBody cube;
  cube.shape = Box{Vec3::Constant(0.5 * edge)};
  cube.mass = mass;
  cube.inertia_B = Vec3::Constant(mass * edge * edge / 6.0);
  cube.start.p_W = p_W;
  return cube;
}

void advance(Island& island, int ticks) {
  for (int i = 0; i < ticks; ++i) island.advance(kPeriod);
}

struct Oscillator {
  double stiffness;  // [N/m]
  double damping;    // [N s/m]
};

/// Displacement of m x'' + B x' + K x = 0 from x0 at rest.
double computeOscillation(const Oscillator& o, double mass, double x0, double t) {
  const double c = o.damping / (2.0 * mass), k = o.stiffness / mass;
  const double discriminant = c * c - k;
  if (discriminant < 0.0) {
    const double w = std::sqrt(-discriminant);
    return x0 * std::exp(-c * t) * (std::cos(w * t) + c / w * std::sin(w * t));
  }
  if (discriminant == 0.0) return x0 * std::exp(-c * t) * (1.0 + c * t);
  const double w = std::sqrt(discriminant), r1 = -c + w, r2 = -c - w;
  return x0 * (r1 * std::exp(r2 * t) - r2 * std::exp(r1 * t)) / (r1 - r2);
}

class LoneCoupler : public ::testing::TestWithParam<Oscillator> {};

// The map is exact: only the rounding of about 500 steps is left.
TEST_P(LoneCoupler, FollowsTheClosedFormToRounding) {
  const double mass = 0.1, x0 = 0.01;
  Island island({});
  const BodyIndex ball = island.addBody(makeBall(mass, Vec3(x0, 0.0, -2.0 * x0)));
  const CouplerIndex coupler =
      island.addCoupler(ball, {{GetParam().stiffness, GetParam().damping}, {}});
  island.prepare();
  island.setTarget(coupler, {});
  double worst = 0.0;
  for (int tick = 1; tick <= 500; ++tick) {
    island.advance(kPeriod);
    const double x = computeOscillation(GetParam(), mass, x0, tick * kPeriod);
    worst = std::max(worst, (island.state(ball).p_W - Vec3(x, 0.0, -2.0 * x)).norm());
  }
  EXPECT_LT(worst, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Gains, LoneCoupler,
                         ::testing::Values(Oscillator{2000.0, 10.0},  // rings
                                           Oscillator{4000.0, 0.0},   // rings for ever
                                           Oscillator{1000.0, 20.0},  // critical
                                           Oscillator{200.0, 30.0},   // one slow and one fast decay
                                           Oscillator{0.0, 0.0}));    // no coupler at all

TEST(Island, DoesNotDependOnHowAPeriodIsSplit) {
  const auto run = [](const std::vector<double>& parts) {
    Island island({});
    const BodyIndex ball = island.addBody(makeBall(0.1, Vec3(0.01, 0.0, 0.0), Vec3(0.0, 0.3, 0.0)));
    island.addCoupler(ball, {{2000.0, 10.0}, {}});
    island.prepare();
    island.setTarget(0, {});
    for (int tick = 0; tick < 300; ++tick)
      for (double part : parts) island.advance(part * kPeriod);
    return island.state(ball).p_W;
  };
  // Each part is resolved to T/2^31 = 2.3e-13 s, at well below 1 m/s, 900 times.
  EXPECT_LT((run({1.0}) - run({0.3, 0.4, 0.3})).norm(), 1e-10);
}

TEST(Island, PrescribedBodyMovesOnAndHeldBodyStays) {
  Island island({});
  IslandBody body = makeBall(0.0, Vec3::Zero(), Vec3(1.0, 2.0, 3.0));
  body.motion = Motion::kPrescribed;
  const BodyIndex prescribed = island.addBody(body);
  body.motion = Motion::kHeld;
  const BodyIndex held = island.addBody(body);
  island.prepare();
  island.advance(kPeriod);
  EXPECT_LT((island.state(prescribed).p_W - kPeriod * Vec3(1.0, 2.0, 3.0)).norm(), 1e-18);
  EXPECT_EQ(island.state(held).p_W, Vec3::Zero());
  EXPECT_EQ(island.state(held).v_W, Vec3(1.0, 2.0, 3.0));
}

// Without outside forces the total momentum of touching bodies is constant (third law).
class MomentumKept : public ::testing::TestWithParam<bool> {};

TEST_P(MomentumKept, ThroughImpactAndRebound) {
  IslandSettings settings;
  if (GetParam()) settings.guide = Vec3::UnitX();
  Island island(settings);
  const double offset = GetParam() ? 0.0 : 0.012;  // off-centre if it may rotate [m]
  const BodyIndex ball =
      island.addBody(makeBall(0.1, Vec3(-0.05, offset, 0.0), Vec3(0.5, 0.0, 0.0)));
  const BodyIndex cube = island.addBody(makeCube(0.25, 0.04));
  island.addContact(ball, cube, {2000.0, 3.0});
  island.prepare();
  const auto momentum = [&]() -> Vec3 {
    return 0.1 * island.state(ball).v_W + 0.25 * island.state(cube).v_W;
  };
  const auto spin = [&]() -> Vec3 {
    return 0.1 * island.state(ball).p_W.cross(island.state(ball).v_W) +
           0.25 * island.state(cube).p_W.cross(island.state(cube).v_W) +
           0.25 * 0.04 * 0.04 / 6.0 * island.state(cube).w_W;
  };
  const Vec3 p0 = momentum(), l0 = spin();
  bool touched = false;
  for (int tick = 0; tick < 300; ++tick) {
    island.advance(kPeriod);
    touched |= island.computeContactForce(ball) != Vec3::Zero();
    EXPECT_EQ(island.computeContactForce(ball), -island.computeContactForce(cube));
  }
  EXPECT_TRUE(touched);
  EXPECT_GT(island.state(cube).v_W.x(), 0.1);
  EXPECT_LT((momentum() - p0).norm(), 1e-14);
  if (!GetParam()) {
    EXPECT_GT(std::abs(island.state(cube).w_W.z()), 0.5);
    // Angular momentum is constant to the order of Runge-Kutta, about (w h)^4.
    EXPECT_LT((spin() - l0).norm(), 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(GuideOrFree, MomentumKept, ::testing::Bool());

// A spring contact returns the energy it stored. The exact map locates make and break to 5e-13 s.
TEST(Island, ElasticImpactKeepsEnergy) {
  for (const bool guided : {true, false}) {
    IslandSettings settings;
    if (guided) settings.guide = Vec3::UnitX();
    Island island(settings);
    const BodyIndex ball =
        island.addBody(makeBall(0.1, Vec3(-0.05, 0.0, 0.0), Vec3(0.5, 0.0, 0.0)));
    const BodyIndex cube = island.addBody(makeCube(0.1, 0.04));
    island.addContact(ball, cube, {4000.0, 0.0});
    island.prepare();
    advance(island, 300);
    // Equal masses swap their velocities.
    EXPECT_NEAR(island.state(ball).v_W.x(), 0.0, 1e-8) << "guided " << guided;
    EXPECT_NEAR(island.state(cube).v_W.x(), 0.5, 1e-8) << "guided " << guided;
  }
}

// A fast sphere passes through a soft box, round edges and past the middle. There another face
// becomes the nearest and the force jumps. A step that does not end at the jump creates energy:
// 3e-3 of it at a fixed step of 0.25 ms.
TEST(Island, EnergyIsKeptWhereTheNearestFaceChanges) {
  constexpr double kSpeed = 3.0;  // [m/s]
  for (const double offset : {0.008, 0.0115, 0.012, 0.0125, 0.016}) {
    Island island({});
    const BodyIndex ball =
        island.addBody(makeBall(0.1, Vec3(-0.05, offset, 0.001), Vec3(kSpeed, 0.0, 0.0)));
    const BodyIndex cube = island.addBody(makeCube(0.25, 0.04));
    island.addContact(ball, cube, {500.0, 0.0});
    island.prepare();
    advance(island, 100);
    ASSERT_EQ(island.computeContactForce(ball), Vec3::Zero());  // out again
    EXPECT_GT(island.state(cube).w_W.norm(), 0.1);
    const double energy = 0.5 * 0.1 * island.state(ball).v_W.squaredNorm() +
                          0.5 * 0.25 * island.state(cube).v_W.squaredNorm() +
                          0.5 * 0.25 * 0.04 * 0.04 / 6.0 * island.state(cube).w_W.squaredNorm();
    // The remaining error, at most 1.2e-6, arises where the centre passes a region of edges.
    EXPECT_NEAR(energy / (0.5 * 0.1 * kSpeed * kSpeed), 1.0, 2e-6) << "offset " << offset;
  }
}

TEST(Island, GuideKeepsAnyAxis) {
  std::mt19937_64 random(20240607);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 20; ++trial) {
    IslandSettings settings;
    settings.guide = Vec3(normal(random), normal(random), normal(random)).normalized();
    Island island(settings);
    const BodyIndex ball = island.addBody(makeBall(0.1));
    island.addCoupler(ball, {{2000.0, 1.0}, {}});
    island.prepare();
    RigidState target;
    target.p_W = Vec3(0.01, -0.02, 0.03);
    island.setTarget(0, target);
    island.setExternalWrench(ball, Vec3(1.0, 2.0, 3.0), Vec3::Zero());
    advance(island, 200);
    const Vec3 p = island.state(ball).p_W;
    EXPECT_LT((p - *settings.guide * settings.guide->dot(p)).norm(), 1e-15)
        << "seed 20240607, trial " << trial;
    EXPECT_GT(p.norm(), 1e-4);
  }
}

// Intermediate-axis tumbling, where the gyroscopic term dominates: energy and momentum stay
// constant.
TEST(Island, FreeRotationKeepsEnergyAndAngularMomentum) {
  Island island({});
  IslandBody body = makeCube(0.2, 0.04);
  body.inertia_B = Vec3(2e-5, 4e-5, 7e-5);
  body.start.w_W = Vec3(0.1, 10.0, 0.05);
  const BodyIndex cube = island.addBody(body);
  island.prepare();
  const auto spin = [&]() -> Vec3 {
    const RigidState& s = island.state(cube);
    return s.q_WB * body.inertia_B.cwiseProduct(s.q_WB.conjugate() * s.w_W);
  };
  const auto energy = [&] { return 0.5 * island.state(cube).w_W.dot(spin()); };
  const Vec3 l0 = spin();
  const double e0 = energy();
  double flipped = 1.0;
  for (int tick = 0; tick < 2000; ++tick) {
    island.advance(kPeriod);
    flipped = std::min(flipped, (island.state(cube).q_WB * Vec3::UnitY()).y());
  }
  EXPECT_LT(flipped, -0.9);  // it tumbled
  EXPECT_LT((spin() - l0).norm() / l0.norm(), 1e-8);
  EXPECT_NEAR(energy() / e0, 1.0, 1e-8);
}

TEST(Island, AngularCouplerTurnsACopyToItsTarget) {
  Island island({});
  const BodyIndex cube = island.addBody(makeCube(0.1, 0.04));
  const double inertia = 0.1 * 0.04 * 0.04 / 6.0;
  island.addCoupler(cube, {{200.0, 4.0}, {2000.0 * inertia, 40.0 * inertia}});
  island.prepare();
  RigidState target;
  target.q_WB = Quat(Eigen::AngleAxisd(1.2, Vec3(1.0, 2.0, -1.0).normalized()));
  island.setTarget(0, target);
  // The rotation about one axis is the damped oscillator theta'' + 40 theta' + 2000 theta = 0.
  double worst = 0.0;
  for (int tick = 1; tick <= 300; ++tick) {
    island.advance(kPeriod);
    const double left = computeOscillation({2000.0, 40.0}, 1.0, 1.2, tick * kPeriod);
    worst = std::max(
        worst, std::abs(island.state(cube).q_WB.angularDistance(target.q_WB) - std::abs(left)));
  }
  EXPECT_LT(worst, 1e-7);
}

TEST(Island, SphereRestsOnAnObstacleAtItsSink) {
  IslandSettings settings;
  settings.obstacle_contact = {2000.0, 20.0};
  Island island(settings);
  IslandBody ball = makeBall(0.1, Vec3(0.0, 0.0, 0.012));
  ball.feels_obstacles = true;
  const BodyIndex index = island.addBody(ball);
  island.prepare();
  const std::vector<Obstacle> floor = {
      {Box{Vec3(1.0, 1.0, 0.05)}, Vec3(0.0, 0.0, -0.05), Quat::Identity()}};
  island.setObstacles(floor);
  island.setExternalWrench(index, Vec3(0.0, 0.0, -0.1 * 9.81), Vec3::Zero());
  advance(island, 2000);
  EXPECT_NEAR(island.state(index).p_W.z(), 0.01 - 0.1 * 9.81 / 2000.0, 1e-9);  // m g / K
  EXPECT_NEAR(island.computeContactForce(index).z(), 0.981, 1e-6);
}

// A body creeps into contact so slowly that the finest step does not change its position. The
// search for the event used to loop for ever.
TEST(Island, GuidePassesAnEventThatRoundingHides) {
  IslandSettings settings;
  settings.guide = Vec3::UnitX();
  for (const double speed : {1e-6, 1e-9, 1e-12, 1e-15, 1e-18}) {
    Island island(settings);
    const BodyIndex ball = island.addBody(makeBall(0.1, Vec3(-0.03, 0.0, 0.0)));
    const BodyIndex cube = island.addBody(makeCube(0.1, 0.04));
    island.addContact(ball, cube, {4000.0, 1.0});
    island.prepare();
    // Both bodies are far along the slot, where the last bit of a position is large, and just in
    // contact.
    RigidState moved = island.state(ball);
    moved.p_W.x() += 0.1, moved.v_W.x() = speed;
    island.setState(ball, moved);
    moved = island.state(cube);
    moved.p_W.x() += 0.1;
    island.setState(cube, moved);
    advance(island, 50);
    EXPECT_NEAR(0.1 * (island.state(ball).v_W.x() + island.state(cube).v_W.x()), 0.1 * speed,
                1e-3 * speed + 1e-15);
  }
}

TEST(Island, ImpulseAddsMomentum) {
  Island island({});
  const BodyIndex cube = island.addBody(makeCube(0.2, 0.04));
  island.prepare();
  island.applyImpulse(cube, Vec3(0.1, 0.0, 0.0), Vec3(0.0, 1e-5, 0.0));
  EXPECT_DOUBLE_EQ(island.state(cube).v_W.x(), 0.5);
  EXPECT_NEAR(island.state(cube).w_W.y(), 1e-5 / (0.2 * 0.04 * 0.04 / 6.0), 1e-12);
}

// The square of a rate can be 0 where the rate is not.
TEST(Island, TurnsAsSlowlyAsNumbersGo) {
  Island island({});
  const BodyIndex ball = island.addBody(makeBall(0.1));
  island.prepare();
  RigidState state = island.state(ball);
  state.w_W = Vec3(1e-170, 0.0, 0.0);
  island.setState(ball, state);
  island.advance(1e-3);
  EXPECT_TRUE(island.state(ball).q_WB.coeffs().allFinite());
}

TEST(Island, RefusesBadValuesByName) {
  const auto message = [](auto action) {
    try {
      action();
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("nothing thrown");
  };
  IslandSettings bad;
  bad.haptic_period = 0.0;
  EXPECT_NE(message([&] { Island{bad}; }).find("haptic period = 0"), std::string::npos);
  bad = {};
  bad.guide = Vec3(1.0, 1.0, 0.0);
  EXPECT_NE(message([&] { Island{bad}; }).find("unit vector"), std::string::npos);

  Island island({});
  EXPECT_NE(message([&] { island.addBody(makeBall(-1.0)); }).find("mass = -1"), std::string::npos);
  EXPECT_NE(message([&] { island.addBody(makeBall(std::nan(""))); }).find("mass = nan"),
            std::string::npos);
  const BodyIndex ball = island.addBody(makeBall(0.1));
  const BodyIndex cube = island.addBody(makeCube(0.1, 0.04));
  EXPECT_NE(message([&] {
              island.addCoupler(ball, {{-1.0, 0.0}, {}});
            }).find("stiffness = -1"),
            std::string::npos);
  EXPECT_NE(message([&] {
              island.addContact(cube, ball, {1.0, 0.0});
            }).find("sphere"),
            std::string::npos);
}

}  // namespace
}  // namespace tandem
