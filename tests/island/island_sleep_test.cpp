#include <algorithm>
#include <functional>
#include <memory>

#include <gtest/gtest.h>

#include "coordination/src/island/island.h"

namespace tandem {
namespace {

constexpr double kPeriod = 1e-3;  // haptic period [s]

/// A device presses a cube on a coupler, and a ball lies on an obstacle. All come to rest.
struct Scene {
  Scene() {
    IslandSettings settings;
    settings.obstacle_contact = {2000.0, 20.0};
    island = std::make_unique<Island>(settings);
    IslandBody device;
    device.motion = Motion::kPrescribed;
    device.start.p_W = Vec3(-0.028, 0.004, 0.0);
    hip = island->addBody(device);
    IslandBody body;
    body.shape = Box{Vec3::Constant(0.02)};
    body.mass = 0.25;
    body.inertia_B = Vec3::Constant(0.25 * 0.04 * 0.04 / 6.0);
    cube = island->addBody(body);
    IslandBody sphere;
    sphere.mass = 0.1;
    sphere.feels_obstacles = true;
    sphere.start.p_W = Vec3(0.1, 0.0, 0.0);
    ball = island->addBody(sphere);
    slot = island->addSlot();
    island->addContact(hip, cube, {2000.0, 10.0});
    const double square = 0.04 * 0.04 / 6.0;
    island->addCoupler(cube, {{2000.0, 30.0}, {2000.0 * square, 30.0 * square}});
    island->addCoupler(ball, {{1000.0, 20.0}, {}});
    island->prepare();
    island->setObstacles(obstacles);
  }

  void advance(int ticks) {
    for (int i = 0; i < ticks; ++i) island->advance(kPeriod);
  }
  void fallAsleep() {
    advance(1500);
    ASSERT_TRUE(island->isAsleep());
  }

  std::vector<Obstacle> obstacles = {{Box{Vec3(0.1, 0.1, 0.01)}, Vec3(0.1, 0.0, -0.019)}};
  std::unique_ptr<Island> island;
  BodyIndex hip, cube, ball, slot;
};

TEST(IslandSleep, DoesNothingWhileNothingMoves) {
  Scene scene;
  EXPECT_FALSE(scene.island->isAsleep());
  scene.fallAsleep();
  const IslandCounters before = scene.island->counters();
  const RigidState cube = scene.island->state(scene.cube);
  scene.advance(100);
  const IslandCounters& after = scene.island->counters();
  EXPECT_EQ(after.advances - before.advances, 100u);
  EXPECT_EQ(after.asleep - before.asleep, 100u);
  EXPECT_EQ(after.contact_searches, before.contact_searches);
  EXPECT_EQ(after.exact_bodies, before.exact_bodies);
  EXPECT_EQ(after.integrated_steps, before.integrated_steps);
  EXPECT_EQ(scene.island->state(scene.cube).p_W, cube.p_W);
}

TEST(IslandSleep, ChangesNoResult) {
  Scene asleep, awake;
  double worst = 0.0;
  for (int tick = 0; tick < 2500; ++tick) {
    asleep.advance(1);
    awake.island->wake();
    awake.advance(1);
    for (BodyIndex b : {asleep.cube, asleep.ball})
      worst = std::max(worst, (asleep.island->state(b).p_W - awake.island->state(b).p_W).norm());
  }
  EXPECT_TRUE(asleep.island->isAsleep());
  EXPECT_EQ(awake.island->counters().asleep, 0u);
  EXPECT_LT(worst, 2e-12);  // sleep drops at most 5e-13 m of the way for each body in touch
}

TEST(IslandSleep, IsNotDisturbedByTheSameValues) {
  Scene scene;
  scene.fallAsleep();
  Island& island = *scene.island;
  const std::uint64_t asleep = island.counters().asleep;
  for (int tick = 0; tick < 10; ++tick) {
    for (BodyIndex b = 0; b < island.bodyCount(); ++b) island.setState(b, island.state(b));
    island.setTarget(0, RigidState{});
    island.setExternalWrench(scene.cube, Vec3::Zero(), Vec3::Zero());
    island.applyImpulse(scene.cube, Vec3::Zero(), Vec3::Zero());
    island.setObstacles(scene.obstacles);
    island.advance(kPeriod);
  }
  EXPECT_EQ(island.counters().asleep, asleep + 10);
}

/// Each change must wake the island before the next advance.
TEST(IslandSleep, EndsWithAnyRealChange) {
  struct Change {
    const char* name;
    bool moves;  ///< true if the cube or ball moves at once
    std::function<void(Scene&)> make;
  };
  const Change changes[] = {
      {"state", true,
       [](Scene& s) {
         RigidState state = s.island->state(s.cube);
         state.p_W.x() += 1e-6;
         s.island->setState(s.cube, state);
       }},
      {"device", true,
       [](Scene& s) {
         RigidState state = s.island->state(s.hip);
         state.v_W.x() = -1e-3;
         s.island->setState(s.hip, state);
       }},
      {"target", true,
       [](Scene& s) {
         RigidState target;
         target.p_W.x() = 1e-6;
         s.island->setTarget(0, target);
       }},
      {"wrench", true,
       [](Scene& s) { s.island->setExternalWrench(s.cube, Vec3(0.1, 0, 0), Vec3::Zero()); }},
      {"impulse", true,
       [](Scene& s) { s.island->applyImpulse(s.cube, Vec3(1e-6, 0, 0), Vec3::Zero()); }},
      {"obstacle", true,
       [](Scene& s) {
         s.obstacles[0].p_WB.z() += 1e-3;
         s.island->setObstacles(s.obstacles);
       }},
      {"fill", false,
       [](Scene& s) {
         IslandBody body;
         body.mass = 1.0;
         body.start.p_W = Vec3(1.0, 1.0, 1.0);
         s.island->fill(s.slot, body);
       }},
      {"wake", false, [](Scene& s) { s.island->wake(); }},
  };
  for (const Change& change : changes) {
    Scene scene;
    scene.fallAsleep();
    const std::uint64_t asleep = scene.island->counters().asleep;
    const Vec3 before[] = {scene.island->state(scene.cube).p_W,
                           scene.island->state(scene.ball).p_W};
    change.make(scene);
    EXPECT_FALSE(scene.island->isAsleep()) << change.name;
    scene.advance(1);
    EXPECT_EQ(scene.island->counters().asleep, asleep) << change.name;
    const Vec3 after[] = {scene.island->state(scene.cube).p_W, scene.island->state(scene.ball).p_W};
    // Sleep drops less than 1e-12 m of the way to rest, which is not counted.
    const double way = (after[0] - before[0]).norm() + (after[1] - before[1]).norm();
    EXPECT_EQ(way > 1e-11, change.moves) << change.name << ": " << way;
  }
}

// A body without a coupler has nothing to stop it: however slow, it must go on.
TEST(IslandSleep, ASlowBodyWithoutCouplerKeepsMoving) {
  Island island({});
  IslandBody ball;
  ball.mass = 0.1;
  ball.start.v_W = Vec3(1e-10, 0.0, 0.0);
  island.addBody(ball);
  island.prepare();
  for (int tick = 0; tick < 1000; ++tick) island.advance(kPeriod);
  EXPECT_FALSE(island.isAsleep());
  EXPECT_NEAR(island.state(0).p_W.x(), 1e-10, 1e-16);
}

TEST(IslandSleep, ABodyWithoutCouplerSleepsWhenItStands) {
  Island island({});
  IslandBody ball;
  ball.mass = 0.1;
  island.addBody(ball);
  island.prepare();
  island.advance(kPeriod);
  EXPECT_TRUE(island.isAsleep());
}

TEST(IslandSleep, AMovingDeviceKeepsItAwake) {
  Scene scene;
  scene.fallAsleep();
  RigidState away = scene.island->state(scene.hip);
  away.p_W.x() -= 0.5;
  away.v_W.y() = 1e-12;
  scene.island->setState(scene.hip, away);
  scene.advance(1500);
  EXPECT_FALSE(scene.island->isAsleep());
}

}  // namespace
}  // namespace tandem
