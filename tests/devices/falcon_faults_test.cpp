// Faults of the line and of the device, in virtual time. Each is reported; the force vanishes,
// stays within its limits throughout, and returns when the device does.

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "devices/falcon_rig.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::FalconRig;

const Vec3 kPush_D(10.0, -25.0, 15.0);  // far above the limit
constexpr double kForce = 8.0;          // the clamped force [N]

/// A device that pushes with kPush_D, against a hand that holds it.
class FalconFaults : public ::testing::Test {
 protected:
  explicit FalconFaults(const FalconSettings& settings = {}, double most_change = 2.0)
      : rig_(test::readyDevice(), settings, makeHand()), most_change_(most_change) {
    press(0.8);
    EXPECT_EQ(state(), FalconState::kReady);
    EXPECT_NEAR(force(), kForce, 0.05);
  }

  static std::unique_ptr<Hand> makeHand() {
    return makeMinimumJerkHand({{0.0, Vec3::Zero()}}, 1000.0, 10.0);
  }

  /// Keeps asking for the force.
  void press(double duration) {
    rig_.run(duration, [this](double now) { rig_.driver.command(kPush_D, now); });
  }
  void pressUntil(FalconState wanted, double longest) {
    for (const double end = rig_.now() + longest; rig_.now() < end && state() != wanted;)
      press(0.001);
    EXPECT_EQ(state(), wanted);
  }
  [[nodiscard]] FalconState state() const { return rig_.driver.status().state; }
  [[nodiscard]] FalconFault fault() const { return rig_.driver.status().fault; }
  [[nodiscard]] double force() { return rig_.emulator.plant().force().norm(); }

  /// The fault is reported within 0.1 s, and the force is gone 0.1 s after it began.
  void expectFault(FalconFault wanted) {
    const double began = rig_.now();
    pressUntil(FalconState::kFault, 0.1);
    EXPECT_EQ(fault(), wanted);
    EXPECT_FALSE(rig_.driver.reading().is_valid);
    press(began + 0.12 - rig_.now());
    EXPECT_LT(rig_.emulator.felt().pushed_at, began + 0.1);
    EXPECT_EQ(force(), 0.0);
  }

  void expectRecovery() {
    pressUntil(FalconState::kReady, 2.0);
    EXPECT_EQ(fault(), FalconFault::kNone);
    EXPECT_LT(force(), 0.2);  // it ramps in again
    press(0.6);
    EXPECT_NEAR(force(), kForce, 0.05);
    expectLimits();
  }

  void expectLimits() {
    EXPECT_LT(rig_.emulator.felt().most_force, kForce * 1.01);
    EXPECT_LT(rig_.emulator.felt().most_change, most_change_ * 1.02);
    EXPECT_LT(rig_.emulator.felt().most_slew, most_change_ * 1000.0 * 1.02);
    EXPECT_EQ(rig_.emulator.strange(), 0U);
  }

  FalconMishaps& mishaps() { return rig_.emulator.mishaps; }

  FalconRig rig_;
  double most_change_;  ///< largest change per frame [N]
};

/// A device whose force may change by only 0.05 N a frame. A fault still removes the force in 30
/// ms, and lasts at least that long.
class SlowFalconFaults : public FalconFaults {
 protected:
  SlowFalconFaults() : FalconFaults(makeSettings(), kForce / 30.0) {}

  static FalconSettings makeSettings() {
    FalconSettings settings;
    settings.force.max_slew = 50.0;
    settings.recovery_time = 0.001;
    return settings;
  }
};

constexpr int kAlways = FalconMishaps::kAlways;

TEST_F(FalconFaults, RepliesThatDoNotCome) {
  mishaps().silent_replies = kAlways;
  expectFault(FalconFault::kNoReply);
  mishaps().silent_replies = 0;
  expectRecovery();
}

TEST_F(FalconFaults, ShortReplies) {
  mishaps().short_replies = kAlways;
  expectFault(FalconFault::kDamagedReplies);
  mishaps().short_replies = 0;
  expectRecovery();
  EXPECT_GT(rig_.driver.status().resyncs, 0U);
}

TEST_F(FalconFaults, LostBytes) {
  mishaps().lost_bytes = kAlways;
  expectFault(FalconFault::kDamagedReplies);
  mishaps().lost_bytes = 0;
  expectRecovery();
}

TEST_F(SlowFalconFaults, RepliesThatDoNotCome) {
  mishaps().silent_replies = kAlways;
  expectFault(FalconFault::kNoReply);
  mishaps().silent_replies = 0;
  expectRecovery();
}

TEST_F(SlowFalconFaults, RepliesThatComeAgainAtOnce) {
  mishaps().short_replies = kAlways;
  pressUntil(FalconState::kFault, 0.1);
  mishaps().short_replies = 0;
  expectRecovery();
}

TEST_F(SlowFalconFaults, HomingThatIsLost) {
  rig_.emulator.loseHoming();
  expectFault(FalconFault::kHomingLost);
  pressUntil(FalconState::kUnhomed, 0.1);
  expectLimits();
}

TEST_F(SlowFalconFaults, AWriterThatDies) {
  const double last = rig_.now();
  rig_.run(0.2);
  EXPECT_LT(rig_.emulator.felt().pushed_at, last + 0.1);
  expectLimits();
}

TEST_F(SlowFalconFaults, AStopOfADeviceThatDoesNotAnswer) {
  mishaps().silent_replies = kAlways;
  rig_.driver.beginStop();
  press(0.05);
  EXPECT_TRUE(rig_.driver.hasStopped());
  EXPECT_EQ(force(), 0.0);
  EXPECT_EQ(rig_.driver.status().faults, 0U);
  expectLimits();
}

TEST_F(FalconFaults, RepliesThatComeTooLate) {
  mishaps().reply_delay = 0.05;
  expectFault(FalconFault::kNoReply);
  mishaps().reply_delay = 0.0;
  expectRecovery();
}

TEST_F(FalconFaults, PiecesThatComeTooLate) {
  mishaps().split_replies = kAlways;
  mishaps().split_time = 0.06;
  pressUntil(FalconState::kFault, 0.1);
  mishaps().split_replies = 0;
  expectRecovery();
}

// A stray wrong byte does not stop the device: it finds the next whole reply.
TEST_F(FalconFaults, OneOfManyIsBorne) {
  for (int i = 0; i < 200; ++i) {
    FalconMishaps& m = mishaps();
    int* const kinds[] = {&m.silent_replies, &m.short_replies,   &m.lost_bytes,
                          &m.doubled_bytes,  &m.strange_replies, &m.split_replies};
    *kinds[i % 6] = 1;
    m.split_time = 0.002;
    press(0.03);
    ASSERT_EQ(state(), FalconState::kReady) << i % 6;
  }
  EXPECT_EQ(rig_.driver.status().faults, 0U);
  EXPECT_GT(rig_.driver.status().missing, 50U);
  EXPECT_NEAR(force(), kForce, 0.05);
  expectLimits();
}

TEST_F(FalconFaults, DoubledBytes) {
  mishaps().doubled_bytes = kAlways;
  pressUntil(FalconState::kFault, 1.0);  // doubled markers do no harm, other bytes delay the driver
  EXPECT_EQ(fault(), FalconFault::kDamagedReplies);
  mishaps().doubled_bytes = 0;
  expectRecovery();
}

TEST_F(FalconFaults, SplitRepliesAreBorne) {
  mishaps().split_replies = kAlways;
  mishaps().split_time = 0.001;
  press(1.0);
  EXPECT_EQ(rig_.driver.status().faults, 0U);
  expectLimits();
}

TEST_F(FalconFaults, HomingThatIsLost) {
  rig_.emulator.loseHoming();
  expectFault(FalconFault::kHomingLost);
  pressUntil(FalconState::kUnhomed, 0.1);
  EXPECT_EQ(rig_.emulator.command().lights, kRedLight);
  rig_.pull(0.04);
  expectRecovery();
}

// Reduced by whole turns, some of these counts would be valid positions.
TEST_F(FalconFaults, CountsThatNoGripCanHave) {
  const auto reply = [](std::int16_t count) {
    return encodeReply({{count, static_cast<std::int16_t>(-count), count}, 7, 0});
  };
  FalconDriver driver(FalconSettings{});
  driver.connect(0.0);
  double now = 0.0;
  const auto answer = [&](const FalconFrame& frame, double duration) {
    for (const double end = now + duration; now < end; now += 0.001) {
      driver.command(kPush_D, now);
      if (driver.advance(now).count > 0) driver.take(frame.data(), frame.size(), now + 0.0005);
    }
  };
  answer(reply(0), 0.1);
  ASSERT_EQ(driver.status().state, FalconState::kReady);
  answer(reply(30000), 0.01);
  EXPECT_EQ(driver.status().state, FalconState::kReady);
  EXPECT_FALSE(driver.reading().is_valid);
  answer(reply(30000), 0.1);
  EXPECT_EQ(driver.status().state, FalconState::kFault);
  EXPECT_EQ(driver.status().fault, FalconFault::kOutOfReach);
  EXPECT_EQ(driver.status().force_D, (std::array<double, 3>{}));
  answer(reply(0), 0.1);
  EXPECT_EQ(driver.status().state, FalconState::kReady);
}

// A busy host is no fault of the device: without a frame there is no reply to miss.
TEST_F(FalconFaults, AHostThatStallsBlamesNobody) {
  for (const double stall : {0.03, 0.3}) {
    rig_.skip(stall);
    press(0.1);
    EXPECT_EQ(state(), FalconState::kReady);
  }
  EXPECT_EQ(rig_.driver.status().faults, 0U);
  EXPECT_EQ(rig_.driver.status().boots, 1U);
  expectLimits();
}

// The host may also be busy between deciding on a frame and sending it. The reply is then still to
// come.
TEST_F(FalconFaults, AHostThatSendsLateBlamesNobody) {
  mishaps().reply_delay = 0.001;
  for (const double stall : {0.03, 0.3}) {
    rig_.sendLate(stall);
    press(0.1);
    EXPECT_EQ(state(), FalconState::kReady);
    EXPECT_NEAR(force(), kForce, 0.05);
  }
  EXPECT_EQ(rig_.driver.status().faults, 0U);
  EXPECT_EQ(rig_.driver.status().boots, 1U);
  expectLimits();
}

// Even a host that is always late must notice missing replies.
TEST_F(FalconFaults, AHostThatIsAlwaysLateNoticesSilence) {
  mishaps().silent_replies = kAlways;
  const double began = rig_.now();
  while (rig_.now() < began + 0.15) {
    rig_.sendLate(0.01);
    press(FalconRig::kLook);
  }
  EXPECT_EQ(fault(), FalconFault::kNoReply);
  EXPECT_EQ(force(), 0.0);
  EXPECT_LT(rig_.emulator.felt().pushed_at, began + 0.15);
  expectLimits();
}

TEST_F(FalconFaults, PowerThatGoesAndComes) {
  rig_.emulator.switchOff(rig_.now());
  expectFault(FalconFault::kNoReply);
  press(0.3);
  EXPECT_EQ(state(), FalconState::kBoot);
  EXPECT_EQ(fault(), FalconFault::kFirmwareLost);
  rig_.emulator.switchOn(rig_.now());
  pressUntil(FalconState::kLoading, 10.0);
  pressUntil(FalconState::kUnhomed, 10.0);
  EXPECT_EQ(force(), 0.0);
  rig_.pull(0.04);
  expectRecovery();
  EXPECT_EQ(rig_.driver.status().boots, 2U);
}

TEST_F(FalconFaults, ALineThatGoesAndComes) {
  rig_.emulator.plugIn(false);
  press(0.2);
  EXPECT_EQ(state(), FalconState::kClosed);
  EXPECT_EQ(fault(), FalconFault::kUnplugged);
  EXPECT_FALSE(rig_.driver.reading().is_valid);
  // The firmware kept its last command; only cutting its power surely ends that. The driver's first
  // frame carries no force; then the force ramps in again.
  rig_.emulator.plugIn(true);
  press(FalconRig::kLook);
  EXPECT_EQ(force(), 0.0);
  pressUntil(FalconState::kReady, 2.0);
  double before = force(), most_change = 0.0;
  EXPECT_LT(before, 0.05);
  rig_.run(0.25, [&](double now) {
    rig_.driver.command(kPush_D, now);
    most_change = std::max(most_change, force() - std::exchange(before, force()));
  });
  EXPECT_NEAR(force(), kForce / 2.0, 0.05);
  EXPECT_LT(most_change, 0.05);  // 8 N in 500 frames
  press(0.4);
  EXPECT_NEAR(force(), kForce, 0.05);
  EXPECT_LT(rig_.emulator.felt().most_force, kForce * 1.01);
  EXPECT_EQ(rig_.driver.status().opened, 2U);
}

TEST_F(FalconFaults, AnEncoderThatIsStuckPushesNoHarder) {
  mishaps().stuck_leg = 1;
  press(0.5);
  // The force is computed from a wrong position, so its direction is wrong. No command is larger.
  EXPECT_LT(rig_.emulator.felt().most_force, kForce * 1.05);
  EXPECT_EQ(rig_.emulator.strange(), 0U);
}

TEST_F(FalconFaults, AJumpIsNoVelocity) {
  double fastest = 0.0;
  for (const double z : {0.145, 0.105, 0.125}) {
    rig_.emulator.plant().hold(Vec3(0.0, 0.01, z));
    rig_.run(0.7, [&](double now) {
      rig_.driver.command(kPush_D, now);
      const FalconReading& reading = rig_.driver.reading();
      if (reading.is_valid)
        fastest = std::max(fastest, Vec3(reading.v[0], reading.v[1], reading.v[2]).norm());
    });
    EXPECT_NEAR(rig_.driver.reading().p[2], z - 0.125, 1e-4);
  }
  EXPECT_EQ(rig_.driver.status().jumps, 3U);
  EXPECT_LT(fastest, 0.2);  // speed of the grip before it was held
  EXPECT_EQ(rig_.emulator.strange(), 0U);
}

// Any faults together, at any time: the limits hold, and afterwards the device is ready.
TEST(FalconFault, DrawnMishapsNeverBreakTheLimits) {
  constexpr std::uint64_t kSeed = 90;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  for (int run = 0; run < 30; ++run) {
    SCOPED_TRACE(run);
    FalconEmulatorSettings device = test::readyDevice();
    device.seed = static_cast<std::uint64_t>(run);
    device.has_usb_times = run % 2 == 1;
    FalconRig rig(device, {}, makeMinimumJerkHand({{0.0, Vec3::Zero()}}, 800.0, 8.0));
    Vec3 f_D = Vec3::Zero();
    double last_write = 0.0;
    bool writes = true;
    const auto press = [&](double duration) {
      rig.run(duration, [&](double now) {
        if (!writes) return;
        rig.driver.command(f_D, now);
        last_write = now;
      });
    };
    for (int i = 0; i < 25; ++i) {
      FalconMishaps& m = rig.emulator.mishaps;
      m = {};
      const auto some = [&random] { return random.below(4) == 0 ? random.below(40) : 0; };
      m.silent_replies = some();
      m.short_replies = some();
      m.lost_bytes = some();
      m.doubled_bytes = some();
      m.strange_replies = some();
      m.split_replies = some();
      m.split_time = random.logUniform(1e-4, 5e-2);
      if (random.below(4) == 0) m.reply_delay = random.logUniform(1e-4, 5e-2);
      if (random.below(8) == 0) rig.emulator.loseHoming();
      f_D = random.direction() * random.logUniform(0.1, 1e6);
      writes = random.below(4) != 0;
      press(random.uniform(0.01, 0.4));
      if (rig.now() - last_write > 0.1) {
        ASSERT_LT(rig.emulator.felt().pushed_at, last_write + 0.1);
      }
      // A pull homes it again.
      rig.pull(0.04);
    }
    rig.emulator.mishaps = {};
    ASSERT_TRUE(rig.runUntil(FalconState::kReady, 30.0));
    // 8 N, for a position up to 20 ms old. At 0.5 m/s the legs have turned further by then.
    ASSERT_LT(rig.emulator.felt().most_force, 8.0 * 1.06);
    ASSERT_LT(rig.emulator.felt().most_change, 2.0 * 1.1);
    ASSERT_EQ(rig.emulator.strange(), 0U);
  }
}

}  // namespace
}  // namespace tandem
