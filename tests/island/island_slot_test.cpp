#include <cmath>

#include <gtest/gtest.h>

#include "coordination/src/island/island.h"

namespace tandem {
namespace {

constexpr double kPeriod = 1e-3;              // haptic period [s]
constexpr double kMass = 0.2;                 // mass of the body in the slot [kg]
constexpr double kEdge = 0.04;                // edge of that body [m]
const CouplerGains kContact = {2000.0, 3.0};  // [N/m, N s/m]

IslandBody makeBox(const Vec3& p_W, const Vec3& v_W = Vec3::Zero()) {
  IslandBody box;
  box.shape = Box{Vec3::Constant(0.5 * kEdge)};
  box.mass = kMass;
  box.inertia_B = Vec3::Constant(kMass * kEdge * kEdge / 6.0);
  box.start.p_W = p_W;
  box.start.v_W = v_W;
  return box;
}

IslandBody makeTool(const Vec3& p_W, const Vec3& v_W) {
  IslandBody tool;
  tool.shape = Sphere{0.01};
  tool.mass = 0.1;
  tool.feels_obstacles = true;
  tool.start.p_W = p_W;
  tool.start.v_W = v_W;
  return tool;
}

IslandSettings makeSettings() {
  IslandSettings settings;
  settings.obstacle_contact = kContact;
  return settings;
}

/// A tool that hits a body in a slot away from its centre.
struct Hit {
  Island island{makeSettings()};
  BodyIndex tool = island.addBody(makeTool(Vec3(-0.05, 0.012, 0.0), Vec3(0.5, 0.0, 0.0)));
  BodyIndex slot = island.addSlot();

  Hit() { island.prepare(); }
  void advance(int ticks) {
    for (int i = 0; i < ticks; ++i) island.advance(kPeriod);
  }
};

TEST(IslandSlot, IsNotThereUntilItIsFilled) {
  Hit hit;
  EXPECT_FALSE(hit.island.isActive(hit.slot));
  EXPECT_FALSE(hit.island.isDynamic(hit.slot));
  EXPECT_TRUE(hit.island.isActive(hit.tool));
  EXPECT_EQ(hit.island.bodyCount(), 2);
  hit.advance(200);  // straight through the place of the empty slot's body
  EXPECT_EQ(hit.island.state(hit.tool).v_W, Vec3(0.5, 0.0, 0.0));
  EXPECT_EQ(hit.island.state(hit.slot).p_W, Vec3::Zero());

  hit.island.fill(hit.slot, makeBox(Vec3(1.0, 0.0, 0.0)));
  EXPECT_TRUE(hit.island.isActive(hit.slot));
  EXPECT_TRUE(hit.island.isDynamic(hit.slot));
  EXPECT_EQ(hit.island.state(hit.slot).p_W, Vec3(1.0, 0.0, 0.0));
}

TEST(IslandSlot, TouchesByTheSameLawAsAPair) {
  Hit hit;
  hit.island.fill(hit.slot, makeBox(Vec3::Zero()));

  Island pair({});
  const BodyIndex tool = pair.addBody(makeTool(Vec3(-0.05, 0.012, 0.0), Vec3(0.5, 0.0, 0.0)));
  const BodyIndex box = pair.addBody(makeBox(Vec3::Zero()));
  pair.addContact(tool, box, kContact);
  pair.prepare();

  bool touched = false;
  for (int tick = 0; tick < 150; ++tick) {
    hit.advance(1);
    pair.advance(kPeriod);
    touched |= hit.island.computeContactForce(hit.slot) != Vec3::Zero();
    ASSERT_EQ(hit.island.computeContactForce(hit.slot), -hit.island.computeContactForce(hit.tool));
    ASSERT_EQ(hit.island.state(hit.slot).p_W, pair.state(box).p_W) << "tick " << tick;
    ASSERT_EQ(hit.island.state(hit.slot).w_W, pair.state(box).w_W) << "tick " << tick;
    ASSERT_EQ(hit.island.state(hit.tool).v_W, pair.state(tool).v_W) << "tick " << tick;
  }
  EXPECT_TRUE(touched);
}

TEST(IslandSlot, KeepsMomentumAndSpinInAHit) {
  Hit hit;
  hit.island.fill(hit.slot, makeBox(Vec3::Zero()));
  const auto momentum = [&]() -> Vec3 {
    return 0.1 * hit.island.state(hit.tool).v_W + kMass * hit.island.state(hit.slot).v_W;
  };
  const auto spin = [&]() -> Vec3 {
    const RigidState &t = hit.island.state(hit.tool), &b = hit.island.state(hit.slot);
    return 0.1 * t.p_W.cross(t.v_W) + kMass * b.p_W.cross(b.v_W) +
           kMass * kEdge * kEdge / 6.0 * b.w_W;
  };
  const Vec3 p0 = momentum(), l0 = spin();
  hit.advance(200);
  EXPECT_GT(std::abs(hit.island.state(hit.slot).w_W.z()), 0.5);
  EXPECT_LT((momentum() - p0).norm(), 1e-14);
  EXPECT_LT((spin() - l0).norm(), 1e-9);  // accurate to the order of the integration
}

TEST(IslandSlot, FliesAParabolaExactly) {
  Hit hit;
  hit.island.fill(hit.slot, makeBox(Vec3(1.0, 0.0, 2.0), Vec3(0.3, 0.0, 1.0)));
  hit.island.setExternalWrench(hit.slot, Vec3(0.0, 0.0, -9.81 * kMass), Vec3::Zero());
  hit.advance(500);
  const double t = 0.5;
  const Vec3 expected(1.0 + 0.3 * t, 0.0, 2.0 + t - 0.5 * 9.81 * t * t);
  EXPECT_LT((hit.island.state(hit.slot).p_W - expected).norm(), 1e-12);
  EXPECT_NEAR(hit.island.state(hit.slot).v_W.z(), 1.0 - 9.81 * t, 1e-12);
}

TEST(IslandSlot, DampingSlowsItExactly) {
  Hit hit;
  IslandBody box = makeBox(Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0));
  box.damping = 3.0;  // [N s/m]
  hit.island.fill(hit.slot, box);
  hit.advance(300);
  const double rate = 3.0 / kMass;
  EXPECT_NEAR(hit.island.state(hit.slot).v_W.y(), std::exp(-rate * 0.3), 1e-13);
  EXPECT_NEAR(hit.island.state(hit.slot).p_W.y(), (1.0 - std::exp(-rate * 0.3)) / rate, 1e-13);
}

TEST(IslandSlot, IsGoneWhenCleared) {
  Hit hit;
  hit.island.fill(hit.slot, makeBox(Vec3::Zero()));
  hit.advance(48);  // in the middle of the hit
  EXPECT_NE(hit.island.computeContactForce(hit.tool), Vec3::Zero());
  hit.island.clear(hit.slot);
  EXPECT_FALSE(hit.island.isActive(hit.slot));
  EXPECT_EQ(hit.island.state(hit.slot).p_W, Vec3::Zero());
  EXPECT_EQ(hit.island.computeContactForce(hit.tool), Vec3::Zero());
  const Vec3 v = hit.island.state(hit.tool).v_W;
  hit.advance(100);
  EXPECT_EQ(hit.island.state(hit.tool).v_W, v);
}

TEST(IslandSlot, StartsAnewWhenFilledAgain) {
  Hit used, fresh;
  used.island.fill(used.slot, makeBox(Vec3(0.5, 0.0, 0.0), Vec3(0.0, 2.0, 0.0)));
  used.island.setExternalWrench(used.slot, Vec3(1.0, 2.0, 3.0), Vec3::Zero());
  used.advance(10);
  fresh.advance(10);
  // Filling over the old body without clearing it leaves nothing of the old one.
  used.island.fill(used.slot, makeBox(Vec3::Zero()));
  fresh.island.fill(fresh.slot, makeBox(Vec3::Zero()));
  used.advance(100);
  fresh.advance(100);
  EXPECT_EQ(used.island.state(used.slot).p_W, fresh.island.state(fresh.slot).p_W);
  EXPECT_EQ(used.island.state(used.tool).p_W, fresh.island.state(fresh.tool).p_W);
}

TEST(IslandSlot, AngularDampingEndsItsTurning) {
  Hit hit;
  IslandBody box = makeBox(Vec3(1.0, 0.0, 0.0));
  box.angular_damping = 5.0;  // [1/s]
  box.start.w_W = Vec3(0.0, 3.0, 4.0);
  hit.island.fill(hit.slot, box);
  Vec3 f_W, t_W;
  hit.island.computeWrench(hit.slot, f_W, t_W);
  const double inertia = kMass * kEdge * kEdge / 6.0;
  EXPECT_LT((t_W + 5.0 * inertia * box.start.w_W).norm(), 1e-18);
  hit.advance(400);
  const double left = std::exp(-5.0 * 0.4);
  EXPECT_LT((hit.island.state(hit.slot).w_W - left * box.start.w_W).norm(), 1e-9);
  const Quat turned(Eigen::AngleAxisd((1.0 - left), Vec3(0.0, 0.6, 0.8)));
  EXPECT_LT(hit.island.state(hit.slot).q_WB.angularDistance(turned), 1e-9);
}

TEST(IslandSlot, IsRefusedInAGuide) {
  IslandSettings settings;
  settings.guide = Vec3::UnitX();
  Island island(settings);
  EXPECT_THROW(island.addSlot(), std::invalid_argument);
}

}  // namespace
}  // namespace tandem
