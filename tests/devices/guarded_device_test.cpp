#include "tandem/falcon/guarded_device.h"

#include <cmath>
#include <memory>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "devices/guard_rig.h"

namespace tandem {
namespace {

using test::GuardRig;
using test::kInf;
using test::kPeriod;
using test::kPush;

TEST(GuardedDevice, GivesNothingBeforeAPositionAndThenRampsIn) {
  GuardRig rig;
  EXPECT_EQ(rig.script.force, Vec3::Zero());
  rig.guard->write(kPush);
  EXPECT_EQ(rig.script.force, Vec3::Zero());
  rig.script.sample.valid = false;
  rig.tickFor(1.0, kPush);
  EXPECT_EQ(rig.script.force, Vec3::Zero());
  EXPECT_EQ(rig.cuts(GuardCut::kNotValid), 0u);  // invalid from the start, so not a cut

  rig.script.sample.valid = true;
  EXPECT_EQ(rig.tick(kPush), Vec3::Zero());
  for (int i = 1; i <= 500; ++i) ASSERT_LT((rig.tick(kPush) - i / 500.0 * kPush).norm(), 1e-9) << i;
  EXPECT_LT((rig.tick(kPush) - kPush).norm(), 1e-12);
  EXPECT_LE(rig.guard->status().ramped, 501u);
  EXPECT_GE(rig.guard->status().ramped, 500u);
  EXPECT_DOUBLE_EQ(rig.guard->status().share, 1.0);
}

TEST(GuardedDevice, ClampsWithTheDirectionKeptHoweverHuge) {
  GuardRig rig;
  rig.warmUp(kPush);
  for (const double size : {10.0, 1e10, 1e200, 1.7e308}) {
    const Vec3 wanted(0.0, 0.6 * size, -0.8 * size);
    const std::uint64_t clamped = rig.guard->status().clamped;
    rig.tickFor(0.01, wanted);
    EXPECT_LT((rig.script.force - Vec3(0.0, 4.8, -6.4)).norm(), 1e-12) << size;
    EXPECT_EQ(rig.guard->status().clamped, clamped + 10);
  }
}

TEST(GuardedDevice, RisesNoFasterThanItsSlewCountedInTime) {
  GuardRig rig;
  rig.warmUp(Vec3::Zero());
  EXPECT_NEAR(rig.tick(kPush).norm(), 2.0, 1e-9);
  rig.guard->write(kPush);  // a second write in the same tick: no time has passed
  EXPECT_NEAR(rig.script.force.norm(), 2.0, 1e-9);
  rig.now += 0.02;  // a late tick counts for two periods
  EXPECT_NEAR(rig.tick(-10.0 * kPush).norm(), 4.0, 1e-9);
  EXPECT_LT(rig.script.force.dot(kPush), 0.0);
  EXPECT_EQ(rig.guard->status().slewed, 3u);
}

// A force that lags behind its cause pushes the hand on, and gives it energy.
TEST(GuardedDevice, FallsAtOnce) {
  GuardRig rig;
  rig.warmUp(kPush);
  EXPECT_EQ(rig.tick(0.25 * kPush), 0.25 * kPush);
  EXPECT_EQ(rig.tick(Vec3::Zero()), Vec3::Zero());
  EXPECT_EQ(rig.guard->status().slewed, 0u);
}

// The fade of 5 N takes 3 ms. At 1 m/s along the force it would give 6 mJ.
TEST(GuardedDevice, AFadeThatPushesTheHandAlongEndsAtOnce) {
  for (const double speed : {1.0, -1.0}) {
    GuardRig rig;
    rig.script.sample.hip.v_W = speed * kPush.normalized();
    rig.warmUp(kPush);
    rig.guard->holdDeadMan(false);
    const double left = rig.tick(kPush).norm();
    EXPECT_NEAR(left, speed > 0.0 ? 0.0 : 3.0, 1e-9);
  }
}

TEST(GuardedDevice, TakesTheDevicesOwnLimitsWhereTheyAreSmaller) {
  DeviceCapabilities device;
  device.name = "told";
  device.max_force = 3.0;
  device.max_slew = 500.0;
  GuardRig rig({}, device);
  EXPECT_EQ(rig.guard->capabilities().name, "told");
  EXPECT_EQ(rig.guard->capabilities().max_force, 3.0);
  EXPECT_EQ(rig.guard->capabilities().max_slew, 500.0);
  rig.warmUp(Vec3::Zero());
  EXPECT_NEAR(rig.tick(kPush).norm(), 0.5, 1e-12);
  rig.tickFor(0.01, kPush);
  EXPECT_NEAR(rig.script.force.norm(), 3.0, 1e-12);
  GuardRig usual;
  EXPECT_EQ(usual.guard->capabilities().max_force, 8.0);
  EXPECT_EQ(usual.guard->capabilities().max_slew, 2000.0);
}

TEST(GuardedDevice, LetsGoBySlewWhenThePositionOrTheDeadManIsLost) {
  for (const bool is_dead_man : {false, true}) {
    GuardRig rig;
    rig.warmUp(kPush);
    rig.script.sample.valid = is_dead_man;
    rig.guard->holdDeadMan(!is_dead_man);
    for (const double left : {3.0, 1.0, 0.0, 0.0}) EXPECT_NEAR(rig.tick(kPush).norm(), left, 1e-9);
    EXPECT_EQ(rig.cuts(is_dead_man ? GuardCut::kDeadMan : GuardCut::kNotValid), 1u);
    EXPECT_TRUE(rig.guard->status().is_cut);
    rig.script.sample.valid = true;
    rig.guard->holdDeadMan(true);
    EXPECT_EQ(rig.tick(kPush), Vec3::Zero());
    rig.tickFor(0.25, kPush);
    EXPECT_NEAR(rig.script.force.norm(), 2.5, 1e-6);
  }
}

TEST(GuardedDevice, ASingleBadReadingLetsGoAllTheWay) {
  for (const double bad : {std::nan(""), kInf}) {
    GuardRig rig;
    rig.warmUp(kPush);
    rig.script.sample.hip.v_W.z() = bad;
    (void)rig.tick(kPush);
    EXPECT_FALSE(rig.guard->read(rig.now).valid);
    rig.script.sample.hip.v_W.z() = 0.0;
    EXPECT_NEAR(rig.tick(kPush).norm(), 1.0, 1e-9);
    EXPECT_EQ(rig.tick(kPush), Vec3::Zero());
    EXPECT_EQ(rig.cuts(GuardCut::kNotValid), 1u);
  }
}

TEST(GuardedDevice, LetsGoForAForceThatIsNoNumber) {
  for (const double bad : {std::nan(""), kInf, -kInf}) {
    GuardRig rig;
    rig.warmUp(kPush);
    EXPECT_NEAR(rig.tick(Vec3(bad, 0, 0)).norm(), 3.0, 1e-9);
    EXPECT_NEAR(rig.tick(kPush).norm(), 1.0, 1e-9);
    EXPECT_EQ(rig.tick(kPush), Vec3::Zero());
    EXPECT_EQ(rig.cuts(GuardCut::kNotFinite), 1u);
    rig.warmUp(kPush);
    EXPECT_LT((rig.script.force - kPush).norm(), 1e-12);
  }
}

TEST(GuardedDevice, LetsGoWhenNobodyWrites) {
  GuardRig rig;
  rig.warmUp(kPush);
  const double last_write = rig.now;
  while (rig.script.force != Vec3::Zero() && rig.now < last_write + 1.0)
    (void)rig.guard->read(rig.now += kPeriod);
  EXPECT_GT(rig.now, last_write + 0.05);
  EXPECT_LT(rig.now, last_write + 0.06);
  EXPECT_EQ(rig.cuts(GuardCut::kStale), 1u);
  EXPECT_EQ(rig.tick(kPush), Vec3::Zero());
  rig.tickFor(0.25, kPush);
  EXPECT_NEAR(rig.script.force.norm(), 2.5, 0.1);
}

TEST(GuardedDevice, RampsInAgainAfterALateRead) {
  GuardRig rig;
  rig.warmUp(kPush);
  rig.now += 0.045;
  EXPECT_LT((rig.tick(kPush) - kPush).norm(), 1e-12);
  rig.now += 0.055;
  EXPECT_EQ(rig.tick(kPush), Vec3::Zero());
  EXPECT_EQ(rig.cuts(GuardCut::kLate), 1u);
  rig.tickFor(0.25, kPush);
  EXPECT_NEAR(rig.script.force.norm(), 2.5, 0.1);
}

TEST(GuardedDevice, IsZeroAtOnceOnATimeThatMakesNoSense) {
  for (const double wrong : {std::nan(""), kInf, -kInf, 1.0}) {
    GuardRig rig;
    rig.warmUp(kPush);
    (void)rig.guard->read(wrong);
    EXPECT_EQ(rig.script.force, Vec3::Zero());
    rig.guard->write(kPush);
    EXPECT_EQ(rig.script.force, Vec3::Zero());
    EXPECT_EQ(rig.cuts(GuardCut::kTime), 1u);
  }
  GuardRig rig;
  rig.warmUp(kPush);
  for (int i = 0; i < 60; ++i) {
    (void)rig.guard->read(rig.now);
    rig.guard->write(kPush);
    EXPECT_EQ(rig.script.force == Vec3::Zero(), i >= 50) << i;
  }
}

TEST(GuardedDevice, HearsOfItsDeadManFromAnotherThread) {
  GuardRig rig;
  std::thread other([&] {
    for (int i = 0; i < 1000; ++i) rig.guard->holdDeadMan(i % 2 == 0);
  });
  rig.tickFor(1.0, kPush);
  other.join();
  rig.tickFor(0.01, kPush);
  EXPECT_EQ(rig.script.force, Vec3::Zero());  // the dead man was released last
  EXPECT_GE(rig.cuts(GuardCut::kDeadMan), 1u);
}

TEST(GuardedDevice, LeavesItsDeviceWithoutForce) {
  GuardRig rig;
  rig.warmUp(kPush);
  EXPECT_GT(rig.script.force.norm(), 4.9);
  rig.guard.reset();
  EXPECT_EQ(rig.script.force, Vec3::Zero());
}

TEST(GuardedDevice, RefusesWhatGuardsNothing) {
  test::DeviceScript script;
  const auto refuses = [&](const GuardSettings& settings) {
    EXPECT_THROW(GuardedDevice(std::make_unique<test::ToldDevice>(script), settings),
                 std::invalid_argument);
  };
  for (const double bad : {0.0, -1.0, kInf, std::nan("")}) {
    refuses({bad, 2000.0, 0.5});
    refuses({8.0, bad, 0.5});
    if (bad != 0.0) refuses({8.0, 2000.0, bad});
  }
  EXPECT_THROW(GuardedDevice(nullptr), std::invalid_argument);
}

TEST(GuardedDevice, TakesTheTorqueWithTheForce) {
  DeviceCapabilities device;
  device.max_torque = 0.1;
  GuardRig rig({}, device);
  EXPECT_EQ(rig.script.torque, Vec3::Zero());
  const Vec3 torque(0.03, 0.0, 0.04);
  rig.tickFor(0.25, kPush);
  rig.guard->writeTorque(torque);
  EXPECT_LT((rig.script.torque - rig.guard->status().share * torque).norm(), 1e-12);
  EXPECT_GT(rig.script.torque.norm(), 0.01);
  rig.warmUp(kPush);
  rig.guard->writeTorque(torque);
  EXPECT_LT((rig.script.torque - torque).norm(), 1e-12);
  rig.guard->writeTorque(10.0 * torque);
  EXPECT_LT((rig.script.torque - 2.0 * torque).norm(), 1e-12);

  rig.guard->holdDeadMan(false);
  rig.tick(kPush);
  EXPECT_EQ(rig.script.torque, Vec3::Zero());
  rig.guard->writeTorque(torque);
  EXPECT_EQ(rig.script.torque, Vec3::Zero());
  rig.guard->holdDeadMan(true);
  rig.warmUp(kPush);
  rig.guard->writeTorque(Vec3(std::nan(""), 0, 0));
  EXPECT_EQ(rig.script.torque, Vec3::Zero());
  EXPECT_EQ(rig.cuts(GuardCut::kNotFinite), 1u);
}

// A wrist that is not finite is no reading.
TEST(GuardedDevice, RefusesAWristThatIsNotFinite) {
  GuardRig rig;
  rig.warmUp(kPush);
  rig.script.sample.wrist = WristState{Quat::Identity(), Vec3(kInf, 0, 0)};
  EXPECT_FALSE(rig.guard->read(rig.now + kPeriod).valid);
}

}  // namespace
}  // namespace tandem
