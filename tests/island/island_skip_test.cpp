// Work that a scene does not need is skipped; a counter shows each skip.

#include <algorithm>

#include <gtest/gtest.h>

#include "coordination/src/island/island.h"

namespace tandem {
namespace {

constexpr double kPeriod = 1e-3;  // haptic period [s]

IslandBody makeBall(Motion motion, const Vec3& p_W) {
  IslandBody ball;
  ball.shape = Sphere{0.01};
  ball.motion = motion;
  ball.mass = motion == Motion::kDynamic ? 0.1 : 0.0;
  ball.start.p_W = p_W;
  return ball;
}

IslandBody makeCube() {
  IslandBody cube;
  cube.shape = Box{Vec3::Constant(0.02)};
  cube.mass = 0.25;
  cube.inertia_B = Vec3::Constant(0.25 * 0.04 * 0.04 / 6.0);
  return cube;
}

/// A device and a cube on a coupler (linear and angular), `place` [m] apart along x.
struct Pair {
  explicit Pair(double place, const IslandSettings& settings = {}) : island(settings) {
    hip = island.addBody(makeBall(Motion::kPrescribed, Vec3(-place, 0.005, 0.0)));
    cube = island.addBody(makeCube());
    island.addContact(hip, cube, {2000.0, 10.0});
    island.addCoupler(cube, {{2000.0, 20.0}, {0.6, 6e-3}});
    island.prepare();
  }
  void advance(int ticks) {
    for (int i = 0; i < ticks; ++i) island.advance(kPeriod);
  }
  /// Moves the target, so that nothing may sleep.
  void pull(const Vec3& p_W) {
    RigidState target;
    target.p_W = p_W;
    island.setTarget(0, target);
  }
  [[nodiscard]] const IslandCounters& counters() const { return island.counters(); }

  Island island;
  BodyIndex hip, cube;
};

TEST(IslandSkip, NoExactGeometryWhileBallsAreApart) {
  Pair pair(0.2);
  pair.pull(Vec3(0.01, 0.0, 0.0));
  pair.advance(50);
  EXPECT_EQ(pair.counters().advances, 50u);
  EXPECT_EQ(pair.counters().contact_searches, 0u);
  EXPECT_EQ(pair.counters().contact_searches_skipped, 50u);

  Pair near(0.04);  // the bounding balls overlap, the shapes do not
  near.pull(Vec3(0.001, 0.0, 0.0));
  near.advance(50);
  EXPECT_EQ(near.counters().contact_searches, 50u);
  EXPECT_EQ(near.counters().contact_searches_skipped, 0u);
}

TEST(IslandSkip, NoExactGeometryForObstaclesFarAway) {
  Island island({});
  IslandBody ball = makeBall(Motion::kDynamic, Vec3::Zero());
  ball.feels_obstacles = true;
  ball.start.v_W = Vec3(0.0, 0.1, 0.0);
  island.addBody(ball);
  island.prepare();
  const std::vector<Obstacle> obstacles(5, {Box{Vec3::Constant(0.1)}, Vec3(1.0, 0.0, 0.0)});
  island.setObstacles(obstacles);
  for (int tick = 0; tick < 20; ++tick) island.advance(kPeriod);
  EXPECT_EQ(island.counters().contact_searches, 0u);
  EXPECT_EQ(island.counters().contact_searches_skipped, 100u);
}

TEST(IslandSkip, ABodyAloneMovesByItsExactMap) {
  Pair pair(0.2);
  pair.pull(Vec3(0.01, 0.0, 0.0));
  pair.advance(50);
  EXPECT_EQ(pair.counters().exact_bodies, 50u);  // the cube; the device needs no map
  EXPECT_EQ(pair.counters().integrated_bodies, 0u);
  EXPECT_EQ(pair.counters().integrated_steps, 0u);
}

TEST(IslandSkip, OnlyTheTurningOfABodyAloneIsIntegrated) {
  Pair pair(0.2);
  RigidState turned;
  turned.q_WB = Quat(Eigen::AngleAxisd(0.1, Vec3::UnitZ()));
  pair.island.setTarget(0, turned);
  pair.advance(50);
  EXPECT_EQ(pair.counters().exact_bodies, 50u);
  EXPECT_EQ(pair.counters().integrated_bodies, 50u);
}

TEST(IslandSkip, ASpinThatNothingTurnsIsExact) {
  Island island({});
  IslandBody cube = makeCube();
  cube.start.w_W = Vec3(1.0, 2.0, 2.0);
  island.addBody(cube);
  island.prepare();
  for (int tick = 0; tick < 500; ++tick) island.advance(kPeriod);
  EXPECT_EQ(island.counters().exact_turns, 500u);
  EXPECT_EQ(island.counters().integrated_steps, 0u);
  const Quat expected(Eigen::AngleAxisd(3.0 * 0.5, Vec3(1.0, 2.0, 2.0) / 3.0));
  // Rounding of 500 products; angularDistance() itself is accurate to 1e-15.
  EXPECT_LT(island.state(0).q_WB.angularDistance(expected), 1e-13);
}

TEST(IslandSkip, ASoftPressTakesOneStepPerPeriod) {
  Pair pair(0.029);
  pair.advance(20);
  const IslandCounters before = pair.counters();
  for (int tick = 0; tick < 50; ++tick) {
    pair.pull(Vec3(-1e-5 * tick, 0.0, 0.0));
    pair.advance(1);
  }
  EXPECT_EQ(pair.counters().integrated_bodies - before.integrated_bodies, 50u);
  EXPECT_LE(pair.counters().integrated_steps - before.integrated_steps, 55u);
}

TEST(IslandSkip, AnEmptySlotCostsNothing) {
  IslandSettings settings;
  Island island(settings);
  IslandBody ball = makeBall(Motion::kDynamic, Vec3::Zero());
  ball.feels_obstacles = true;
  ball.start.v_W = Vec3(0.0, 0.1, 0.0);
  island.addBody(ball);
  for (int i = 0; i < 4; ++i) island.addSlot();
  island.prepare();
  for (int tick = 0; tick < 10; ++tick) island.advance(kPeriod);
  EXPECT_EQ(island.counters().contact_searches + island.counters().contact_searches_skipped, 0u);
  EXPECT_EQ(island.counters().exact_bodies, 10u);
}

// A ball on a spring bounces on a cube: each touch is made and lost within some step. Bisection to
// 1e-13 s would take 33 tries.
TEST(IslandSkip, MomentsOfTouchAreFoundInAFewTries) {
  Island island({});
  IslandBody ball = makeBall(Motion::kDynamic, Vec3(-0.04, 0.0, 0.0));
  const BodyIndex index = island.addBody(ball);
  IslandBody cube = makeCube();
  cube.motion = Motion::kHeld;
  const BodyIndex other = island.addBody(cube);
  island.addContact(index, other, {2000.0, 1.0});
  const CouplerIndex spring = island.addCoupler(index, {{200.0, 0.0}, {}});
  island.prepare();
  RigidState aim;
  aim.p_W = Vec3(-0.025, 0.0, 0.0);
  island.setTarget(spring, aim);
  for (int tick = 0; tick < 2000; ++tick) island.advance(kPeriod);
  const IslandCounters& counters = island.counters();
  EXPECT_GT(counters.events, 20u);
  EXPECT_LT(counters.event_tries, 7 * counters.events);
}

TEST(IslandSkip, AbsurdGainsTakeABoundedNumberOfSteps) {
  for (const double damping : {0.0, 1e3}) {
    Island island({});
    IslandBody ball = makeBall(Motion::kDynamic, Vec3(-0.05, 0.01, 0.0));
    ball.mass = 1e-3;
    ball.start.v_W = Vec3(10.0, 0.0, 0.0);
    const BodyIndex index = island.addBody(ball);
    IslandBody cube = makeCube();
    cube.mass = 1e-3;
    cube.inertia_B = Vec3::Constant(1e-3 * 0.04 * 0.04 / 6.0);
    const BodyIndex other = island.addBody(cube);
    island.addContact(index, other, {1e6, damping});
    island.prepare();
    std::uint64_t most = 0, before = 0;
    for (int tick = 0; tick < 100; ++tick) {
      island.advance(kPeriod);
      const std::uint64_t steps =
          island.counters().integrated_steps + island.counters().rejected_steps;
      most = std::max(most, steps - before);
      before = steps;
    }
    // 4096 sub-steps in a period, plus some for retries and for events that cut a step.
    EXPECT_LT(most, 5000u) << "damping " << damping;
    EXPECT_TRUE(isFinite(island.state(index)));
    const double energy =
        0.5e-3 * (island.state(index).v_W.squaredNorm() + island.state(other).v_W.squaredNorm());
    EXPECT_LT(energy, 0.05 * (1.0 + 1e-6)) << "damping " << damping;
  }
}

}  // namespace
}  // namespace tandem
