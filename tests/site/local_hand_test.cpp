// Private header of the plugin: the local hand, its energy and its force.
#include "plugin/src/site/local_hand.h"

#include <limits>

#include <gtest/gtest.h>

#include "site/parts_rig.h"

namespace tandem {
namespace {

using test::kPeriod;
using test::PartsRig;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

void readAt(PartsRig& rig, const Vec3& p_W, const Vec3& v_W = Vec3::Zero(), double now = 0.0) {
  rig.device.sample = {{p_W, v_W}, true};
  rig.hand.read(now);
}

/// Renders a contact force, as one tick does.
Vec3 render(PartsRig& rig, const Vec3& contact_W, bool fault = false) {
  rig.hand.render(contact_W, Vec3::Zero(), rig.peers, fault);
  rig.hand.write();
  return rig.device.force_W;
}

TEST(LocalHand, PutsTheHipWhereTheHandIs) {
  PartsRig rig;
  readAt(rig, Vec3(0.1, 0.2, 0.3), Vec3(1, 2, 3));
  rig.hand.place();
  EXPECT_EQ(rig.island.state(rig.hand.hip()).p_W, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(rig.island.state(rig.hand.hip()).v_W, Vec3(1, 2, 3));
}

TEST(LocalHand, KeepsTheHipAndStopsItWithoutASample) {
  for (const bool is_valid : {false, true}) {
    PartsRig rig;
    readAt(rig, Vec3(0.1, 0, 0), Vec3(1, 0, 0));
    rig.hand.place();
    // No sample, or one with a NaN.
    rig.device.sample = {{Vec3(is_valid ? kNan : 0.5, 0, 0), Vec3(5, 0, 0)}, is_valid};
    rig.hand.read(0.001);
    EXPECT_FALSE(rig.hand.isThere());
    rig.hand.lead(0.01);
    EXPECT_EQ(rig.island.state(rig.hand.hip()).v_W, Vec3(1, 0, 0));
    rig.hand.place();
    EXPECT_EQ(rig.island.state(rig.hand.hip()).p_W, Vec3(0.1, 0, 0));
    EXPECT_EQ(rig.island.state(rig.hand.hip()).v_W, Vec3(0, 0, 0));
  }
}

TEST(LocalHand, RefusesADeviceWithoutAPosition) {
  test::FakeDevice device;
  device.sample.valid = false;
  Island island{IslandSettings{}};
  EXPECT_THROW(LocalHand(device, SiteSettings{}, island, true), Error);
}

TEST(LocalHand, LeadsTheHipSteadilyOverTicksThatWereLeftOut) {
  PartsRig rig;
  readAt(rig, Vec3(0.02, 0, 0));
  rig.hand.lead(5 * kPeriod);
  for (int i = 0; i < 5; ++i) rig.island.advance(kPeriod);
  EXPECT_LT((rig.island.state(rig.hand.hip()).p_W - Vec3(0.02, 0, 0)).norm(), 1e-15);
}

TEST(LocalHand, CountsTheWorkOfTheForceAsItWasHeld) {
  PartsRig rig;
  const PassivityObserver& observer = rig.hand.energy().observer();
  ASSERT_TRUE(rig.hand.energy().isKept());
  readAt(rig, Vec3(0.1, 0, 0));
  rig.hand.countWork();
  EXPECT_EQ(observer.own(), 0.0);  // no position one tick ago
  render(rig, Vec3(-2, 1, 0));
  readAt(rig, Vec3(0.103, 0.001, 0));
  rig.hand.countWork();
  // The hand pushed against the force: -f . dp = 2 N 3 mm - 1 N 1 mm.
  EXPECT_NEAR(observer.own(), 5e-3, 1e-15);
}

// A wrong reading leaps there and back. A hand that was away for a while may be elsewhere.
TEST(LocalHand, CountsNoWorkOfALeap) {
  PartsRig rig;
  const PassivityObserver& observer = rig.hand.energy().observer();
  readAt(rig, Vec3::Zero());
  rig.hand.countWork();
  double now = 0.0;
  for (const double x : {0.02, 0.0, -1.0, 0.0}) {
    render(rig, Vec3(-1, 0, 0));
    readAt(rig, Vec3(x, 0, 0), Vec3::Zero(), now += kPeriod);
    rig.hand.countWork();
    EXPECT_EQ(observer.own(), 0.0) << x;
  }
  render(rig, Vec3(-1, 0, 0));
  readAt(rig, Vec3(0.02, 0, 0), Vec3::Zero(), now + 0.1);
  rig.hand.countWork();
  EXPECT_NEAR(observer.own(), 0.02, 1e-15);
}

TEST(LocalHand, IsNeverFasterThanAHand) {
  for (const double speed : {11.0, 1e3, 1e30, 1e200}) {
    PartsRig rig;
    rig.device.limits.is_continuous = true;
    readAt(rig, Vec3::Zero(), Vec3(0, speed, 0));
    rig.hand.place();
    EXPECT_LE(rig.island.state(rig.hand.hip()).v_W.norm(), 10.0 + 1e-12) << speed;
    EXPECT_LE(rig.hand.pointAt(5e-4, 0.0).v_W.norm(), 10.0 + 1e-12) << speed;
    rig.device.sample.wrist = WristState{Quat::Identity(), Vec3(0, 0, 10.0 * speed)};
    rig.hand.read(kPeriod);
    EXPECT_LE(rig.hand.wrist()->w_W.norm(), 100.0 + 1e-10) << speed;
  }
}

// The fading force acts on while the device gives no sample, so its work must count.
TEST(LocalHand, CountsTheWorkOverAGapAsIfTheHandMovedOn) {
  PartsRig rig;
  const PassivityObserver& observer = rig.hand.energy().observer();
  readAt(rig, Vec3::Zero(), Vec3(0.5, 0, 0));
  rig.hand.countWork();
  render(rig, Vec3(2, 0, 0));
  rig.device.sample.valid = false;
  rig.hand.read(0.001);
  rig.hand.countWork();
  EXPECT_NEAR(observer.own(), -1e-3, 1e-15);  // 2 N over 0.5 mm
  render(rig, Vec3::Zero());
  readAt(rig, Vec3(0.1, 0, 0));
  rig.hand.countWork();
  EXPECT_NEAR(observer.own(), -1e-3, 1e-15);
}

// With 15 mJ of 20 mJ taken, half of the band of 10 mJ is left: half of the force.
TEST(LocalHand, GetsLessForceAsItsEnergyRunsOutWithPeersOrAlone) {
  for (const bool is_connected : {true, false}) {
    PartsRig rig;
    test::FakeLink link;
    if (is_connected) rig.connect(link);
    readAt(rig, Vec3::Zero());
    rig.hand.countWork();
    render(rig, Vec3(1, 0, 0));
    readAt(rig, Vec3(0.015, 0, 0), Vec3(0.1, 0, 0), 0.15);
    rig.hand.place();
    rig.hand.countWork();
    rig.hand.render(Vec3(2, 0, 0), Vec3::Zero(), rig.peers, false);
    EXPECT_NEAR(rig.hand.force().x(), 1.0, 1e-12);
    EXPECT_EQ(rig.hand.contact(), Vec3(2, 0, 0));
    EXPECT_EQ(rig.hand.energy().limitedCount(), 1u);
  }
}

// fault_slew = 2000 N/s is 2 N per tick.
TEST(LocalHand, FadesWhenToldToAndOnAFault) {
  for (const bool is_fault : {true, false}) {
    PartsRig rig;
    EXPECT_EQ(render(rig, Vec3(0, 5, 0)), Vec3(0, 5, 0));
    rig.hand.setFading(!is_fault);
    for (const double left : {3.0, 1.0, 0.0, 0.0})
      EXPECT_NEAR(render(rig, Vec3(0, 5, 0), is_fault).y(), left, 1e-15);
    rig.hand.setFading(false);
    EXPECT_EQ(render(rig, Vec3(0, 5, 0)), Vec3(0, 5, 0));
    rig.hand.letGo();
    EXPECT_EQ(rig.device.force_W, Vec3(0, 0, 0));
  }
}

TEST(LocalHand, KeepsToTheSlowerSlewAndTheDevicesForce) {
  test::FakeDevice device;
  device.limits.max_force = 3.0;   // [N]
  device.limits.max_slew = 500.0;  // [N/s]: 0.5 N per tick
  SiteSettings settings;
  settings.max_slew = kInf;
  Island island{IslandSettings{}};
  LocalHand hand(device, settings, island, true);
  Bodies bodies;
  SiteLog log;
  const Peers none(settings, island, bodies, hand.energy(), log);
  for (int i = 1; i <= 10; ++i) {
    hand.render(Vec3(0, 0, 8), Vec3::Zero(), none, false);
    EXPECT_NEAR(hand.force().z(), std::min(3.0, 0.5 * i), 1e-14) << i;
  }
  EXPECT_EQ(hand.guard().clampedCount(), 10u);
}

// A torque rises within 20 ms to the device's limit, and fades with the force.
TEST(LocalHand, RendersATorqueWithinTheDevicesLimit) {
  test::FakeDevice device;
  device.limits.max_torque = 0.1;  // [N m]
  Island island{IslandSettings{}};
  const SiteSettings settings;
  LocalHand hand(device, settings, island, true);
  Bodies bodies;
  SiteLog log;
  const Peers none(settings, island, bodies, hand.energy(), log);
  ASSERT_TRUE(hand.feelsTorque());
  const Vec3 wanted(0.0, 0.3, -0.4);
  for (int i = 1; i <= 25; ++i) {
    hand.render(Vec3::Zero(), wanted, none, false);
    hand.write();
    EXPECT_NEAR(device.torque_W.norm(), std::min(0.1, 0.005 * i), 1e-12) << i;
    EXPECT_GT(device.torque_W.dot(wanted), 0.0);
  }
  for (int i = 1; i <= 25; ++i) {
    hand.render(Vec3::Zero(), wanted, none, true);
    hand.write();
    EXPECT_NEAR(device.torque_W.norm(), std::max(0.0, 0.1 - 0.005 * i), 1e-12) << i;
  }
}

// A wrist whose quaternion is no rotation turns nothing.
TEST(LocalHand, TakesOnlyAWristThatIsUsable) {
  PartsRig rig;
  rig.device.sample = {{}, true, WristState{Quat(0.6, 0.0, 0.8, 0.0), Vec3(1, 0, 0)}};
  rig.hand.read(0.0);
  ASSERT_TRUE(rig.hand.wrist());
  for (const Quat& bad : {Quat(0, 0, 0, 0), Quat(2, 0, 0, 0), Quat(kNan, 0, 0, 0)}) {
    rig.device.sample.wrist->q_WH = bad;
    rig.hand.read(0.001);
    EXPECT_EQ(rig.hand.wrist()->q_WH.coeffs(), Quat(0.6, 0.0, 0.8, 0.0).coeffs());
    EXPECT_EQ(rig.hand.wrist()->w_W, Vec3::Zero());
  }
}

TEST(LocalHand, ReadsAContinuousDeviceAgainInsideATick) {
  for (const bool is_continuous : {true, false}) {
    PartsRig rig;
    rig.device.limits.is_continuous = is_continuous;
    readAt(rig, Vec3(0.1, 0, 0));
    rig.hand.place();
    rig.device.sample.hip.p_W = Vec3(0.2, 0, 0);
    EXPECT_EQ(rig.hand.pointAt(0.0, 0.0).p_W, Vec3(0.1, 0, 0));
    EXPECT_EQ(rig.hand.pointAt(5e-4, 0.0).p_W, Vec3(is_continuous ? 0.2 : 0.1, 0, 0));
    rig.device.sample.valid = false;
    EXPECT_EQ(rig.hand.pointAt(5e-4, 0.0).p_W, Vec3(0.1, 0, 0));
  }
}

}  // namespace
}  // namespace tandem
