// Force through all bytes in virtual time: commanded to the driver, measured at the emulator's
// grip.

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "devices/falcon_rig.h"
#include "falcon/src/novint/falcon_force_gate.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::FalconRig;

constexpr double kDegree = 3.14159265358979323846 / 180.0;
const Vec3 kCentre_D(0.0, 0.0, 0.125);

/// Commands a force at every step until it is constant.
void press(FalconRig& rig, const Vec3& f_D, double duration) {
  rig.run(duration, [&](double now) { rig.driver.command(f_D, now); });
}

double angleBetween(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

struct Worst {
  double angle = 0.0, size = 0.0;
};

/// Commands forces of 5 N over a cube of 6 cm and compares them with the emulated hand's.
Worst findWorst(double device_motors_per_torque) {
  FalconEmulatorSettings device = test::readyDevice();
  device.plant.motors_per_torque = device_motors_per_torque;
  FalconSettings settings;
  settings.force.ramp_in = 0.0;
  constexpr std::uint64_t kSeed = 80;
  test::Random random(kSeed);
  FalconRig rig(device, settings);
  EXPECT_TRUE(rig.runUntil(FalconState::kReady, 1.0));
  Worst worst;
  for (int i = 0; i < 7 * 7 * 7; ++i) {
    const Vec3 at = 0.01 * Vec3(i % 7 - 3, i / 7 % 7 - 3, i / 49 - 3);
    EXPECT_TRUE(rig.emulator.plant().hold(Vec3(kCentre_D + at)));
    const Vec3 f_D = 5.0 * random.direction();
    press(rig, f_D, 0.02);
    const Vec3 felt_D = rig.emulator.plant().force();
    worst.angle = std::max(worst.angle, angleBetween(felt_D, f_D));
    worst.size = std::max(worst.size, std::abs(felt_D.norm() / 5.0 - 1.0));
  }
  EXPECT_EQ(rig.driver.status().state, FalconState::kReady);
  EXPECT_EQ(rig.emulator.strange(), 0U);
  return worst;
}

TEST(FalconForce, IsFeltAsItIsAskedForInACubeOfSixCentimetres) {
  const Worst worst = findWorst(kUsualMotorsPerTorque);
  RecordProperty("worst_angle_degree", std::to_string(worst.angle / kDegree));
  RecordProperty("worst_size_percent", std::to_string(worst.size * 100.0));
  EXPECT_LT(worst.angle, 0.1 * kDegree);
  EXPECT_LT(worst.size, 0.005);
}

// A wrong motor constant scales the force and keeps its direction. A spring balance can therefore
// find it.
TEST(FalconForce, AWrongMotorConstantIsFelt) {
  const Worst worst = findWorst(10000.0);
  EXPECT_LT(worst.angle, 0.1 * kDegree);
  EXPECT_NEAR(worst.size, 1.0 - kUsualMotorsPerTorque / 10000.0, 0.005);
}

TEST(FalconForce, NeverWrapsWhateverIsAskedFor) {
  constexpr std::uint64_t kSeed = 81;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  for (const double motors_per_torque : {4200.0, 20000.0}) {
    FalconSettings settings;
    settings.motors_per_torque = motors_per_torque;
    settings.force.ramp_in = 0.0;
    FalconEmulatorSettings device = test::readyDevice();
    device.plant.motors_per_torque = motors_per_torque;
    FalconRig rig(device, settings);
    ASSERT_TRUE(rig.runUntil(FalconState::kReady, 1.0));
    const double inf = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 200; ++i) {
      ASSERT_TRUE(rig.emulator.plant().hold(Vec3(kCentre_D + random.inCube(0.03))));
      Vec3 f_D = random.direction() * random.logUniform(1e-3, 1e300);
      press(rig, f_D, 0.02);
      if (i % 10 == 0) {
        for (const double bad : {inf, -inf, std::nan("")}) press(rig, Vec3(1.0, bad, 0.0), 0.01);
        ASSERT_EQ(rig.emulator.command().motors, FalconMotors{});
        continue;
      }
      const Vec3 felt_D = rig.emulator.plant().force();
      ASSERT_GT(felt_D.dot(f_D.stableNormalized()), 0.0);
      ASSERT_LT(felt_D.norm(), 8.0 * 1.001);
    }
    EXPECT_EQ(rig.emulator.strange(), 0U);
  }
}

// Legs that are nearly stretched turn a small torque into any force. The force of a pose a
// millisecond old was 2700 N at a grip that 8 N had pushed to the end of the legs.
TEST(FalconForce, AGripAtTheEndOfItsLegsFeelsNoMoreThanTheLimit) {
  constexpr std::uint64_t kSeed = 83;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  for (int run = 0; run < 100; ++run) {
    const Vec3 f_D = 1e3 * random.direction();
    FalconRig free(test::readyDevice());
    ASSERT_TRUE(free.runUntil(FalconState::kReady, 1.0));
    press(free, f_D, 1.5);
    ASSERT_LT(free.emulator.felt().most_force, 8.0 * 1.05) << f_D;
    ASSERT_LT(free.emulator.felt().most_rise, 2.0 * 1.1) << f_D;

    // A hand takes the grip there and back, at up to 1 m/s.
    const Vec3 end = 0.09 * random.direction();
    auto hand = makeMinimumJerkHand(
        {{0.6, Vec3::Zero()}, {0.8, end}, {1.0, Vec3::Zero()}, {1.2, end}}, 2000.0, 15.0);
    FalconRig led(test::readyDevice(), {}, std::move(hand));
    ASSERT_TRUE(led.runUntil(FalconState::kReady, 1.0));
    press(led, f_D, 1.4);
    ASSERT_LT(led.emulator.felt().most_force, 8.0 * 1.1) << f_D << '\n' << end;
  }
}

TEST(FalconForce, ComesInAfterHomingAndShowsItsLights) {
  constexpr double kStart = 5.0;  // start of the hand, after booting [s]
  const Vec3 f_D(4.0, 0.0, 0.0);
  FalconRig rig({}, {}, test::makeHomingHand(kStart));
  press(rig, f_D, kStart);
  EXPECT_EQ(rig.driver.status().state, FalconState::kUnhomed);
  EXPECT_EQ(rig.emulator.command().lights, kRedLight);
  EXPECT_FALSE(rig.driver.reading().is_valid);

  while (rig.driver.status().state == FalconState::kUnhomed && rig.now() < kStart + 2.0) {
    EXPECT_EQ(rig.emulator.felt().most_force, 0.0);
    press(rig, f_D, FalconRig::kLook);
  }
  ASSERT_EQ(rig.driver.status().state, FalconState::kReady);
  EXPECT_EQ(rig.emulator.homed(), 7);
  press(rig, f_D, 0.25);
  EXPECT_NEAR(rig.emulator.plant().force().norm(), 2.0, 0.05);  // half of the ramp
  press(rig, f_D, 2.0);
  EXPECT_NEAR(rig.emulator.plant().force().norm(), 4.0, 0.01);
  EXPECT_EQ(rig.emulator.command().lights, kGreenLight | kBlueLight);
  press(rig, Vec3::Zero(), 0.1);
  EXPECT_EQ(rig.emulator.command().lights, kGreenLight);
  EXPECT_EQ(rig.driver.status().jumps, 0U);
}

TEST(FalconForce, IsGoneATenthOfASecondAfterTheLastWrite) {
  FalconRig rig(test::readyDevice());
  ASSERT_TRUE(rig.runUntil(FalconState::kReady, 1.0));
  press(rig, Vec3(0.0, 8.0, 0.0), 0.7);
  EXPECT_NEAR(rig.emulator.plant().force().norm(), 8.0, 0.02);
  const double last = rig.now();
  rig.run(0.049);
  EXPECT_NEAR(rig.emulator.plant().force().norm(), 8.0, 0.02);
  rig.run(0.2);
  EXPECT_LT(rig.emulator.felt().pushed_at, last + 0.1);
  EXPECT_EQ(rig.emulator.command().motors, FalconMotors{});
  EXPECT_LT(rig.emulator.felt().most_change, 2.0 * 1.02);
}

TEST(FalconForce, AStopTakesItAwayAndPutsTheLightsOut) {
  FalconRig rig(test::readyDevice());
  ASSERT_TRUE(rig.runUntil(FalconState::kReady, 1.0));
  press(rig, Vec3(0.0, 8.0, 0.0), 0.7);
  rig.driver.beginStop();
  const std::uint64_t before = rig.emulator.commands();
  for (int i = 0; i < 100 && !rig.driver.hasStopped(); ++i) press(rig, Vec3(0, 8.0, 0), 0.001);
  EXPECT_TRUE(rig.driver.hasStopped());
  EXPECT_EQ(rig.emulator.command().motors, FalconMotors{});
  EXPECT_EQ(rig.emulator.command().lights, 0);
  EXPECT_TRUE(rig.emulator.command().homes);  // the next program finds it homed
  EXPECT_LE(rig.emulator.commands() - before, 20U);
  EXPECT_LT(rig.emulator.felt().most_change, 2.0 * 1.02);
}

// A spring rendered at a grip in a moving hand: the whole loop, including the mechanism.
TEST(FalconForce, PositionsAndVelocitiesAreThoseOfTheGrip) {
  auto hand = makeMinimumJerkHand(
      {{0.3, Vec3::Zero()}, {1.0, Vec3(0.03, -0.02, 0.02)}, {1.7, Vec3(-0.02, 0.03, -0.01)}},
      1500.0, 15.0);
  FalconEmulatorSettings device = test::readyDevice();
  FalconRig rig(device, {}, std::move(hand));
  double worst_p = 0.0, fastest = 0.0, spread = 0.0;
  int readings = 0;
  rig.run(2.0, [&](double now) {
    const FalconReading& reading = rig.driver.reading();
    if (!reading.is_valid) return;
    const Vec3 p(reading.p[0], reading.p[1], reading.p[2]),
        v(reading.v[0], reading.v[1], reading.v[2]);
    rig.driver.command(-100.0 * p, now);
    worst_p = std::max(worst_p, (p + kCentre_D - rig.emulator.plant().position()).norm());
    spread = std::max(spread, p.norm());
    fastest = std::max(fastest, v.norm());
    ++readings;
  });
  EXPECT_GT(readings, 7000);
  EXPECT_GT(spread, 0.03);
  // Half a count of each encoder, plus the way of a millisecond at 0.15 m/s.
  EXPECT_LT(worst_p, 0.0003);
  // 0.15 m/s; one count of difference in a millisecond is 0.04 m/s or more.
  EXPECT_LT(fastest, 0.4);
  EXPECT_EQ(rig.driver.status().jumps, 0U);
}

TEST(FalconForceGate, NoRiseIsLargerThanTheSlewLimit) {
  constexpr std::uint64_t kSeed = 82;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  const FalconForceLimits limits;
  FalconForceGate gate(limits);
  double now = 0.0, last = 0.0;
  Vec3 before = Vec3::Zero();
  for (int i = 0; i < 100000; ++i) {
    now += random.logUniform(1e-5, 1e-1);
    const Vec3 wanted = random.direction() * random.logUniform(1e-3, 1e300);
    const Vec3 after = gate.advance(wanted, random.uniform(0.0, 0.12), random.below(20) != 0, now);
    ASSERT_LE(after.norm(), limits.max_force * (1.0 + 1e-12));
    ASSERT_LE(after.norm() - before.norm(), limits.max_slew * std::min(now - last, 0.001) + 1e-12);
    before = after;
    last = now;
  }
}

// Even with a slow slew limit, a force that must vanish is gone in 30 ms, evenly.
TEST(FalconForceGate, WhatMustGoDoesNotWaitForASlowSlewLimit) {
  const Vec3 push(0.0, 8.0, 0.0), bad(0.0, std::nan(""), 0.0);
  const auto framesToZero = [&](double max_slew, const Vec3& wanted, double age, bool is_open) {
    FalconForceLimits limits;
    limits.max_slew = max_slew;
    FalconForceGate gate(limits);
    double now = 0.0;
    while (gate.force() != push) gate.advance(push, 0.0, true, now += 0.001);
    int frames = 0;
    for (; gate.force() != Vec3::Zero() && frames < 1000; ++frames) {
      const double before = gate.force().y();
      gate.advance(wanted, age, is_open, now += 0.001);
      EXPECT_LE(before - gate.force().y(), std::max(max_slew * 0.001, 8.0 / 30.0) + 1e-12);
    }
    return frames;
  };
  for (const double max_slew : {20.0, 50.0, 266.0}) {
    EXPECT_NEAR(framesToZero(max_slew, push, 0.0, false), 30, 1);  // closed
    EXPECT_NEAR(framesToZero(max_slew, push, 0.1, true), 30, 1);   // not renewed
    EXPECT_NEAR(framesToZero(max_slew, bad, 0.0, true), 30, 1);
  }
  EXPECT_NEAR(framesToZero(2000.0, push, 0.0, false), 4, 1);
}

// A force that lags behind its cause pushes the hand on.
TEST(FalconForceGate, ARequestThatFallsIsFollowedAtOnce) {
  FalconForceGate gate(FalconForceLimits{});
  double now = 0.0;
  while (gate.force() != Vec3(0, 8, 0)) gate.advance(Vec3(0, 8, 0), 0.0, true, now += 0.001);
  for (const double wanted : {5.0, 0.5, 0.0})
    EXPECT_EQ(gate.advance(Vec3(0, wanted, 0), 0.0, true, now += 0.001), Vec3(0, wanted, 0));
}

TEST(FalconForce, SettingsOutOfRangeAreRefused) {
  const auto refuses = [](void (*change)(FalconSettings&)) {
    FalconSettings settings;
    change(settings);
    EXPECT_THROW((void)FalconDriver(settings), std::invalid_argument);
  };
  refuses([](FalconSettings& s) { s.force.max_force = 9.0; });
  refuses([](FalconSettings& s) { s.force.max_force = std::nan(""); });
  refuses([](FalconSettings& s) { s.force.max_slew = 0.0; });
  refuses([](FalconSettings& s) { s.force.ramp_in = -1.0; });
  refuses([](FalconSettings& s) { s.force.hold = 0.0; });
  refuses([](FalconSettings& s) { s.force.fade = std::nan(""); });
  refuses([](FalconSettings& s) { s.motors_per_torque = 0.0; });
  refuses([](FalconSettings& s) { s.motors_per_torque = 30000.0; });
  refuses([](FalconSettings& s) { s.centre_D.x() = std::nan(""); });
  refuses([](FalconSettings& s) { s.firmware_time = 0.01; });
  refuses([](FalconSettings& s) { s.firmware_time = s.reply_time + 2.0 * s.quiet_time + 0.02; });
  refuses([](FalconSettings& s) { s.boot.tries = 0; });
  refuses([](FalconSettings& s) { s.boot.calls = 0; });
  for (double BootSettings::*time :
       {&BootSettings::back_off, &BootSettings::max_back_off, &BootSettings::probe_time,
        &BootSettings::call_period, &BootSettings::echo_time, &BootSettings::start_time}) {
    for (const double bad : {0.0, -1.0, std::nan("")}) {
      FalconSettings settings;
      settings.boot.*time = bad;
      EXPECT_THROW((void)FalconDriver(settings), std::invalid_argument);
    }
  }
}

}  // namespace
}  // namespace tandem
