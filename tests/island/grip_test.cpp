// Grips in the island: the law, its limits, and contact before and after.

#include <cmath>

#include <gtest/gtest.h>

#include "coordination/src/island/island.h"
#include "support/random.h"

namespace tandem {
namespace {

constexpr double kPeriod = 1e-3;  // [s]

/// A hand and a cube in free space.
struct Scene {
  Island island{IslandSettings{}};
  BodyIndex hand, cube;
  GripIndex grip;
  IslandGrip hold;

  explicit Scene(double mass, const Vec3& p_W = Vec3::Zero(), bool touches = false) {
    IslandBody body;
    body.motion = Motion::kPrescribed;
    hand = island.addBody(body);
    IslandBody box;
    box.shape = Box{Vec3(0.02, 0.03, 0.04)};
    box.mass = mass;
    box.inertia_B = mass / 3.0 * Vec3(0.0025, 0.0020, 0.0013);
    box.start.p_W = p_W;
    cube = island.addBody(box);
    if (touches) island.addContact(hand, cube, {4000.0, 1.0});
    grip = island.addGrip(hand);
    island.prepare();
    hold.body = cube;
    hold.gains = {{2000.0, 2.0 * std::sqrt(2000.0 * mass)}, {1.8, 0.01}};
    hold.max_force = 40.0;
    hold.max_torque = 1.2;
  }
  void take() { island.setGrip(grip, &hold); }
  void moveHand(const Vec3& p_W, const Vec3& v_W) {
    island.setState(hand, {p_W, Quat::Identity(), v_W, Vec3::Zero()});
  }
};

// Before the device's limits the hand feels minus what the body gets, to the bit.
TEST(Grip, ReactionIsMinusAction) {
  test::Random random(48);
  for (const double mass : {0.02, 0.1, 1.0, 5.0}) {
    Scene scene(mass);
    scene.hold.p_FG = random.direction() * 0.03;
    scene.take();
    Vec3 p_W = Vec3::Zero();
    for (int tick = 0; tick < 500; ++tick) {
      const Vec3 v_W = random.direction() * 0.3;
      scene.moveHand(p_W, v_W);
      const GripPull pull = scene.island.computeGripPull(scene.grip);
      EXPECT_EQ(scene.island.computeContactForce(scene.hand), -pull.f_W);
      Vec3 f_W, t_W;
      scene.island.computeWrench(scene.cube, f_W, t_W);
      EXPECT_EQ(f_W, pull.f_W);
      const Vec3 arm_W = scene.island.state(scene.cube).q_WB * scene.hold.p_FG;
      EXPECT_LT((t_W - pull.t_W - arm_W.cross(pull.f_W)).norm(), 1e-12);
      scene.island.advance(kPeriod);
      p_W += kPeriod * v_W;
      ASSERT_TRUE(isFinite(scene.island.state(scene.cube)));
    }
  }
}

// Along a line through the centre the law is that of a damped oscillator with a moving end.
TEST(Grip, FollowsTheClosedForm) {
  constexpr double kMass = 0.5, kStart = 0.005, kSpeed = 0.1;
  Scene scene(kMass, Vec3(kStart, 0, 0));
  scene.take();
  const double w = std::sqrt(2000.0 / kMass);  // critical damping
  for (int tick = 0; tick < 200; ++tick) {
    const double t = tick * kPeriod;
    scene.moveHand(Vec3(kSpeed * t, 0, 0), Vec3(kSpeed, 0, 0));
    // y = x - hand: y'' + 2 w y' + w^2 y = 0
    const double y = (kStart + (-kSpeed + w * kStart) * t) * std::exp(-w * t);
    EXPECT_NEAR(scene.island.state(scene.cube).p_W.x(), kSpeed * t + y, 1e-9);
    scene.island.advance(kPeriod);
  }
}

TEST(Grip, PullsNoHarderThanItsLimits) {
  Scene scene(1.0, Vec3(0.5, 0, 0));
  scene.hold.q_WF = Quat(Eigen::AngleAxisd(2.5, Vec3::UnitY()));
  scene.take();
  const GripPull pull = scene.island.computeGripPull(scene.grip);
  EXPECT_TRUE(pull.is_limited);
  EXPECT_NEAR(pull.f_W.norm(), 40.0, 1e-12);
  EXPECT_NEAR(pull.t_W.norm(), 1.2, 1e-12);
  scene.island.advance(kPeriod);
  EXPECT_NEAR(scene.island.state(scene.cube).v_W.norm(), 40.0 * kPeriod, 1e-9);
}

TEST(Grip, TurnsTheBodyToItsOrientation) {
  Scene scene(0.2);
  scene.hold.p_FG = Vec3(0.02, 0, 0);
  scene.hold.q_WF = Quat(Eigen::AngleAxisd(0.5, Vec3(1, 2, 3).normalized()));
  scene.hold.gains.angular.damping = 0.03;
  scene.take();
  for (int tick = 0; tick < 1000; ++tick) scene.island.advance(kPeriod);
  const RigidState& cube = scene.island.state(scene.cube);
  EXPECT_LT(cube.q_WB.angularDistance(scene.hold.q_WF), 1e-6);
  EXPECT_LT((cube.p_W + cube.q_WB * scene.hold.p_FG).norm(), 1e-6);
}

// Hand and body are at one place: contact must neither push now, nor throw later.
TEST(Grip, SuspendsContactAndLetsItInGently) {
  Scene scene(0.1, Vec3::Zero(), true);
  scene.take();
  for (int tick = 0; tick < 100; ++tick) scene.island.advance(kPeriod);
  EXPECT_LT(scene.island.state(scene.cube).p_W.norm(), 1e-12);
  EXPECT_EQ(scene.island.computeOverlap(scene.hand), 0.0);
  scene.island.setGrip(scene.grip, nullptr);
  double fastest = 0.0;
  for (int tick = 0; tick < 2000; ++tick) {
    scene.island.advance(kPeriod);
    fastest = std::max(fastest, scene.island.state(scene.cube).v_W.norm());
  }
  EXPECT_GT(scene.island.state(scene.cube).p_W.norm(), 0.02);  // it was let out
  EXPECT_LT(fastest, 0.2);
}

TEST(Grip, WithoutShareItOnlyKeepsThemApart) {
  Scene scene(0.1, Vec3(0.01, 0, 0), true);
  scene.hold.share = 0.0;
  scene.take();
  for (int tick = 0; tick < 100; ++tick) scene.island.advance(kPeriod);
  EXPECT_EQ(scene.island.state(scene.cube).p_W, Vec3(0.01, 0, 0));
  EXPECT_EQ(scene.island.computeContactForce(scene.hand), Vec3::Zero());
}

// The reaction moves a hand that forces move: a proxy.
TEST(Grip, KeepsTheMomentumOfTwoBodies) {
  Island island{IslandSettings{}};
  IslandBody body;
  body.mass = 0.1;
  const BodyIndex proxy = island.addBody(body);
  IslandBody held;
  held.shape = Box{Vec3(0.02, 0.02, 0.02)};
  held.mass = 2.0;
  held.inertia_B.setConstant(5e-4);
  held.start.p_W = Vec3(0.0, 0.01, 0.0);
  const BodyIndex cube = island.addBody(held);
  const GripIndex grip = island.addGrip(proxy);
  island.prepare();
  IslandGrip hold;
  hold.body = cube;
  hold.p_FG = Vec3(0.02, 0, 0);
  hold.gains = {{2000.0, 5.0}, {}};
  hold.max_force = 40.0;
  island.setGrip(grip, &hold);
  island.applyImpulse(proxy, Vec3(0.02, 0.0, 0.01), Vec3::Zero());
  for (int tick = 0; tick < 300; ++tick) {
    island.advance(kPeriod);
    const Vec3 momentum_W = 0.1 * island.state(proxy).v_W + 2.0 * island.state(cube).v_W;
    EXPECT_LT((momentum_W - Vec3(0.02, 0.0, 0.01)).norm(), 1e-11);
  }
  EXPECT_GT(island.state(cube).v_W.norm(), 1e-3);
}

// Against a damper that works to rest, a body that is turned at 2 rad/s would lag by 11 mrad.
TEST(Grip, TurnsWithItsHandWithoutLag) {
  constexpr double kRate = 2.0;  // [rad/s]
  Scene scene(0.2);
  scene.hold.w_W = Vec3(0, 0, kRate);
  double lag = 0.0;
  for (int tick = 0; tick < 500; ++tick) {
    scene.hold.q_WF = Quat(Eigen::AngleAxisd(kRate * tick * kPeriod, Vec3::UnitZ()));
    scene.take();
    const RigidState& cube = scene.island.state(scene.cube);
    if (tick > 300) lag = std::max(lag, cube.q_WB.angularDistance(scene.hold.q_WF));
    scene.island.advance(kPeriod);
  }
  // The wanted orientation stands for each tick.
  EXPECT_LT(lag, kRate * kPeriod);
  EXPECT_NEAR(scene.island.state(scene.cube).w_W.z(), kRate, 1e-2);
}

// The tool touches in its place, also obstacles.
TEST(Grip, AHandWithAToolTouchesNothing) {
  Island island{IslandSettings{}};
  IslandBody body;
  body.motion = Motion::kPrescribed;
  body.feels_obstacles = true;
  const BodyIndex hand = island.addBody(body);
  IslandBody box;
  box.shape = Box{Vec3::Constant(0.02)};
  box.mass = 0.5;
  box.inertia_B.setConstant(1e-4);
  box.start.p_W = Vec3(0.028, 0, 0);
  const BodyIndex near = island.addBody(box);
  box.start.p_W = Vec3(0, 0.5, 0);
  IslandGrip hold;
  hold.body = island.addBody(box);
  hold.offset_W = Vec3(0, 0.5, 0);
  hold.gains = {{1500.0, 5.0}, {0.9, 5e-3}};
  hold.max_force = 40.0;
  hold.max_torque = 1.0;
  island.addContact(hand, near, {4000.0, 1.0});
  island.setTouchMemory(false);  // deep contacts push at once
  const GripIndex grip = island.addGrip(hand);
  island.prepare();
  Obstacle wall;
  wall.shape = Box{Vec3::Constant(0.02)};
  wall.p_WB = Vec3(-0.027, 0, 0);
  const std::vector<Obstacle> obstacles{wall};
  island.setObstacles(obstacles);

  island.setGrip(grip, &hold);
  EXPECT_GT(island.computeContactForce(hand).norm(), 1.0);
  hold.is_tool = true;
  island.setGrip(grip, &hold);
  EXPECT_LT(island.computeContactForce(hand).norm(), 1e-12);
  EXPECT_EQ(island.computeOverlap(hand), 0.0);
  for (int tick = 0; tick < 100; ++tick) island.advance(kPeriod);
  EXPECT_EQ(island.state(near).p_W, Vec3(0.028, 0, 0));
  island.setGrip(grip, nullptr);
  EXPECT_GT(island.computeContactForce(hand).norm(), 1.0);
}

// Room for a grip that is never used changes no bit.
TEST(Grip, CostsNothingUnused) {
  const auto run = [](bool has_room) {
    Island island{IslandSettings{}};
    IslandBody body;
    body.motion = Motion::kPrescribed;
    body.start.p_W = Vec3(-0.031, 0.002, 0.001);
    body.start.v_W = Vec3(0.1, 0, 0);
    const BodyIndex hand = island.addBody(body);
    IslandBody box;
    box.shape = Box{Vec3(0.02, 0.02, 0.02)};
    box.mass = 0.2;
    box.inertia_B.setConstant(5e-5);
    const BodyIndex cube = island.addBody(box);
    island.addContact(hand, cube, {4000.0, 1.0});
    island.addCoupler(cube, {{200.0, 3.0}, {0.05, 0.001}});
    if (has_room) island.addGrip(hand);
    island.prepare();
    for (int tick = 0; tick < 200; ++tick) island.advance(kPeriod);
    return island.state(cube);
  };
  const RigidState with = run(true), without = run(false);
  EXPECT_EQ(with.p_W, without.p_W);
  EXPECT_EQ(with.v_W, without.v_W);
  EXPECT_EQ(with.q_WB.coeffs(), without.q_WB.coeffs());
  EXPECT_GT(with.p_W.norm(), 1e-3);
}

TEST(Grip, IsNotForAGuidedIsland) {
  IslandSettings settings;
  settings.guide = Vec3::UnitX();
  Island island(settings);
  IslandBody body;
  body.motion = Motion::kPrescribed;
  const BodyIndex hand = island.addBody(body);
  EXPECT_THROW(island.addGrip(hand), std::invalid_argument);
}

}  // namespace
}  // namespace tandem
