// Contacts that begin deep, because something came or was put there, are let in gently.

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "coordination/src/island/island.h"

namespace tandem {
namespace {

constexpr double kPeriod = 1e-3;    // haptic period [s]
constexpr double kRadius = 0.01;    // radius of the hand [m]
constexpr double kHalfEdge = 0.04;  // of the box [m]
constexpr double kLeaving = 0.101;  // top speed of a thing that is let out, in ticks of 1 ms [m/s]

struct Case {
  double mass, stiffness, depth;  // [kg], [N/m], [m]
};

RigidState at(const Vec3& p_W, const Vec3& v_W = Vec3::Zero()) {
  RigidState state;
  state.p_W = p_W;
  state.v_W = v_W;
  return state;
}

IslandBody makeHand(const Vec3& p_W) {
  IslandBody hand;
  hand.shape = Sphere{kRadius};
  hand.motion = Motion::kPrescribed;
  hand.feels_obstacles = true;
  hand.start = at(p_W);
  return hand;
}

IslandBody makeBox(double mass, const Vec3& p_W) {
  IslandBody box;
  box.shape = Box{Vec3::Constant(kHalfEdge)};
  box.mass = mass;
  box.inertia_B = Vec3::Constant(mass * kHalfEdge * kHalfEdge * 2.0 / 3.0);
  box.start = at(p_W);
  return box;
}

Obstacle makeWall(const Vec3& p_W, std::uint64_t id = 1) {
  Obstacle wall{Box{Vec3::Constant(kHalfEdge)}, p_W};
  wall.id = id;
  return wall;
}

/// Place of a hand above a box at the origin, `depth` deep.
Vec3 over(double depth) { return {0.003, kHalfEdge + kRadius - depth, 0.002}; }

IslandSettings makeSettings(const CouplerGains& contact) {
  IslandSettings settings;
  settings.obstacle_contact = contact;
  return settings;
}

/// A hand and a free box without gravity.
struct Pair {
  Island island;
  BodyIndex hand, box;
  Vec3 impulse_W = Vec3::Zero();  // of the hand on the box [N s]
  double top_speed = 0.0;         // of the box [m/s]

  Pair(double mass, const CouplerGains& contact, const Vec3& p_hand_W, const Vec3& p_box_W,
       const IslandSettings& settings = {})
      : island(settings),
        hand(island.addBody(makeHand(p_hand_W))),
        box(island.addBody(makeBox(mass, p_box_W))) {
    island.addContact(hand, box, contact);
    island.prepare();
  }
  [[nodiscard]] double force() const { return island.computeContactForce(hand).norm(); }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      impulse_W -= kPeriod * island.computeContactForce(hand);
      island.advance(kPeriod);
      top_speed = std::max(top_speed, island.state(box).v_W.norm());
    }
  }
  /// The contact begins without force, and moves the box out at a limited speed.
  void expectGentleExit(int ticks) {
    EXPECT_EQ(force(), 0.0);
    run(ticks);
    EXPECT_LT(top_speed, kLeaving);
    EXPECT_GT(top_speed, 1e-3);
  }
};

class Jump : public ::testing::TestWithParam<Case> {};

TEST_P(Jump, HandThatStartsInABodyIsLetOut) {
  const auto [mass, stiffness, depth] = GetParam();
  Pair pair(mass, {stiffness, 0.0}, over(depth), Vec3::Zero());
  pair.expectGentleExit(3000);
  EXPECT_EQ(pair.island.computeOverlap(pair.hand), 0.0);
}

TEST_P(Jump, BodyPutOntoAHandIsLetOut) {
  const auto [mass, stiffness, depth] = GetParam();
  Pair pair(mass, {stiffness, 0.0}, over(depth), Vec3(0.0, -1.0, 0.0));
  pair.run(10);
  pair.island.setState(pair.box, at(Vec3::Zero()));
  pair.expectGentleExit(3000);
  EXPECT_EQ(pair.island.computeOverlap(pair.hand), 0.0);
}

TEST_P(Jump, GuidedIslandLetsOutTheSame) {
  const auto [mass, stiffness, depth] = GetParam();
  IslandSettings settings;
  settings.guide = Vec3::UnitY();
  Pair pair(mass, {stiffness, 0.0}, over(depth), Vec3::Zero(), settings);
  pair.expectGentleExit(1000);
  pair.island.setState(pair.box, at(Vec3::Zero()));
  pair.expectGentleExit(3000);
  EXPECT_EQ(pair.island.computeOverlap(pair.hand), 0.0);
}

TEST_P(Jump, BothGetTheSameImpulse) {
  const auto [mass, stiffness, depth] = GetParam();
  Pair pair(mass, {stiffness, 3.0}, over(depth), Vec3::Zero());
  pair.run(3000);
  const Vec3 momentum_W = mass * pair.island.state(pair.box).v_W;
  // The hand's force is that of each tick's start.
  EXPECT_LT((momentum_W - pair.impulse_W).norm(), 0.03 * momentum_W.norm());
}

INSTANTIATE_TEST_SUITE_P(MassesAndDepths, Jump,
                         ::testing::Values(Case{0.02, 4000, 0.02}, Case{0.2, 1000, 0.02},
                                           Case{0.2, 4000, 0.02}, Case{0.2, 4000, 0.045},
                                           Case{0.2, 8000, 0.002}, Case{2.0, 4000, 0.005},
                                           Case{20.0, 500, 0.02}));

/// A hand held in the wall; the force over time.
struct AtWall {
  std::vector<Obstacle> walls;
  Island island{makeSettings({4000.0, 3.0})};
  BodyIndex hand;

  explicit AtWall(const Vec3& p_W) : hand(island.addBody(makeHand(p_W))) { island.prepare(); }
  [[nodiscard]] double force() const { return island.computeContactForce(hand).norm(); }
  void expectToGrowFromZero(double depth) {
    EXPECT_EQ(force(), 0.0);
    for (int tick = 1; tick <= 1000; ++tick) {
      island.advance(kPeriod);
      // The force follows the allowance in the middle of the tick before.
      const double pushing = std::min(0.05, depth / 0.2) * (tick - 0.5) * kPeriod;  // [m]
      const bool is_over = pushing + 0.03 * kPeriod > depth;
      EXPECT_NEAR(force(), 4000.0 * (is_over ? depth : pushing), is_over ? 0.2 : 1e-6);
    }
  }
};

TEST(JumpAtWall, HandThatStartsInAWallFeelsItGrow) {
  for (const double depth : {0.0015, 0.02}) {
    AtWall scene(over(depth));
    scene.walls = {makeWall(Vec3::Zero())};
    scene.island.setObstacles(scene.walls);
    scene.expectToGrowFromZero(depth);
  }
}

TEST(JumpAtWall, WallThatComesOntoAHandGrows) {
  AtWall scene(over(0.02));
  scene.island.advance(kPeriod);
  scene.walls = {makeWall(Vec3::Zero())};
  scene.walls[0].change = ObstacleChange::kNew;
  scene.island.setObstacles(scene.walls);
  scene.expectToGrowFromZero(0.02);
}

TEST(JumpAtWall, WallThatIsPutOntoAHandGrows) {
  AtWall scene(over(0.02));
  scene.walls = {makeWall(Vec3(1.0, 0.0, 0.0))};
  scene.island.setObstacles(scene.walls);
  scene.island.advance(kPeriod);
  scene.walls = {makeWall(Vec3::Zero())};
  scene.walls[0].change = ObstacleChange::kMoved;
  scene.walls[0].p_before_WB = Vec3(1.0, 0.0, 0.0);
  scene.island.setObstacles(scene.walls);
  scene.expectToGrowFromZero(0.02);
}

// A platform that the host moves as a fixed object, by 1 mm in each of its steps, carries the hand.
TEST(JumpAtWall, FixedObjectThatMovesInSmallStepsPushesAtOnce) {
  AtWall scene(over(0.0));
  Vec3 p_W = Vec3::Zero();
  scene.walls = {makeWall(p_W)};
  scene.island.setObstacles(scene.walls);
  scene.island.advance(kPeriod);
  for (int step = 1; step <= 5; ++step) {
    scene.walls[0].change = ObstacleChange::kMoved;
    scene.walls[0].p_before_WB = p_W;
    p_W.y() = 1e-3 * step;
    scene.walls[0].p_WB = p_W;
    scene.island.setObstacles(scene.walls);
    EXPECT_NEAR(scene.force(), 4.0 * step, 1e-9);
    for (int tick = 0; tick < 16; ++tick) scene.island.advance(kPeriod);
  }
}

TEST(JumpAtWall, DeviceThatIsBackFeelsTheGrowthOnly) {
  AtWall scene(over(0.0));
  scene.walls = {makeWall(Vec3::Zero())};
  scene.island.setObstacles(scene.walls);
  scene.island.advance(kPeriod);
  scene.island.setState(scene.hand, at(over(0.001)));
  scene.island.advance(kPeriod);
  EXPECT_NEAR(scene.force(), 4.0, 1e-6);
  scene.island.noteArrival(scene.hand);
  scene.island.setState(scene.hand, at(over(0.021)));
  EXPECT_NEAR(scene.force(), 4.0, 0.11);
  scene.island.advance(kPeriod);
  EXPECT_NEAR(scene.force(), 4.2, 0.11);
  // Out again, it has the wall at its surface.
  for (const double depth : {0.001, 0.0}) {
    scene.island.setState(scene.hand, at(over(depth)));
    scene.island.advance(kPeriod);
  }
  scene.island.setState(scene.hand, at(over(0.001), Vec3(0.0, -1.0, 0.0)));
  EXPECT_NEAR(scene.force(), 4.0 + 3.0, 1e-6);
}

// Neither a fast hand nor a device that samples at 100 Hz jumps.
TEST(JumpAtWall, MotionIsFeltAtOnce) {
  for (const int ticks_per_sample : {1, 10}) {
    for (const double speed : {0.1, 1.0, 2.0}) {
      AtWall scene(over(-0.1));
      scene.walls = {makeWall(Vec3::Zero())};
      scene.island.setObstacles(scene.walls);
      double depth = -0.1;
      for (int tick = 0; depth < 0.01; ++tick) {
        if (tick % ticks_per_sample == 0) depth = -0.1 + speed * kPeriod * tick;
        scene.island.setState(scene.hand, at(over(depth), Vec3(0.0, -speed, 0.0)));
        const double force = depth > 0.0 ? 4000.0 * depth + 3.0 * speed : 0.0;
        EXPECT_NEAR(scene.force(), force, 1e-6);
        scene.island.advance(kPeriod);
      }
    }
  }
}

TEST(JumpOfNeighbour, NewcomerAroundAHandIsLetOut) {
  Island island{makeSettings({4000.0, 0.0})};
  const BodyIndex hand = island.addBody(makeHand(over(0.02)));
  const BodyIndex slot = island.addSlot();
  island.prepare();
  island.advance(kPeriod);
  island.fill(slot, makeBox(0.2, Vec3::Zero()));
  EXPECT_EQ(island.computeContactForce(hand), Vec3::Zero());
  double top_speed = 0.0;
  for (int tick = 0; tick < 3000; ++tick) {
    island.advance(kPeriod);
    top_speed = std::max(top_speed, island.state(slot).v_W.norm());
    // The host changes its damping: the slot is filled anew, in the same place.
    IslandBody same = makeBox(0.2, Vec3::Zero());
    same.start = island.state(slot);
    if (tick % 7 == 0) island.fill(slot, same);
  }
  EXPECT_LT(top_speed, kLeaving);
  EXPECT_EQ(island.computeOverlap(hand), 0.0);
}

// Received states of a user at 1 m/s, one in 30 ms: the proxy pushes as it did.
TEST(JumpOfProxy, GapBetweenPacketsIsNoJump) {
  Island island{IslandSettings{}};
  IslandBody proxy = makeHand(Vec3(0.0, 0.2, 0.0));
  proxy.motion = Motion::kHeld;
  proxy.feels_obstacles = false;
  const BodyIndex held = island.addBody(proxy);
  const BodyIndex box = island.addBody(makeBox(1000.0, Vec3::Zero()));
  island.addContact(held, box, {1000.0, 0.0});
  island.prepare();
  for (int tick = 0; tick <= 170; ++tick) {
    if (tick % 30 == 0)
      island.setState(held, at(Vec3(0.0, 0.2 - kPeriod * tick, 0.0), Vec3(0.0, -1.0, 0.0)));
    island.advance(kPeriod);
  }
  const double depth = kHalfEdge + kRadius - island.state(held).p_W.y() + island.state(box).p_W.y();
  EXPECT_NEAR(island.computeContactForce(box).norm(), 1000.0 * depth, 1e-6);
  EXPECT_LT(island.state(held).p_W.y(), 0.0501);
}

// The cube that a proxy jumps into sleeps.
TEST(JumpOfSleeper, BodyAsleepIsLetOut) {
  Island island{IslandSettings{}};
  IslandBody far = makeHand(Vec3(0.0, 1.0, 0.0));
  far.motion = Motion::kHeld;
  const BodyIndex proxy = island.addBody(far);
  const BodyIndex box = island.addBody(makeBox(0.2, Vec3::Zero()));
  island.addContact(proxy, box, {4000.0, 0.0});
  const BodyIndex mover = island.addBody(makeBox(1.0, Vec3(5.0, 0.0, 0.0)));
  island.prepare();
  island.setState(mover, at(Vec3(5.0, 0.0, 0.0), Vec3(1e-3, 0.0, 0.0)));
  for (int tick = 0; tick < 20; ++tick) island.advance(kPeriod);
  const std::vector<BodyIndex> awake = island.awakeBodies();
  ASSERT_EQ(std::count(awake.begin(), awake.end(), box), 0);
  island.setState(proxy, at(over(0.02)));
  double top_speed = 0.0;
  for (int tick = 0; tick < 3000; ++tick) {
    island.advance(kPeriod);
    top_speed = std::max(top_speed, island.state(box).v_W.norm());
  }
  EXPECT_LT(top_speed, kLeaving);
  EXPECT_GT(top_speed, 0.04);
}

}  // namespace
}  // namespace tandem
