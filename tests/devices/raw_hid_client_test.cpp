#include "hid/raw_hid_client.h"

#include <gtest/gtest.h>

#include "devices/raw_hid_emulator.h"
#include "support/random.h"

// Ages, fades and ramps to the microsecond in given time; raw_hid_device_test.cpp tests the
// threads. The arms are 50 mm long and along the axes: 1000 of a torque are 1 N. In all tests no
// report exceeds 8 N or changes the force by more than 2 N.

namespace tandem {
namespace {

constexpr double kArm = 0.05;  // [m]
constexpr double kCount = kRawHidTorque / kArm;
const Vec3 kFull(8.0, 0.0, 0.0);

struct Given {
  Vec3 f_D;
  int flags;
  std::uint16_t number;
};

class RawHidClientTest : public testing::Test {
 protected:
  explicit RawHidClientTest(double ramp_in = 0.0)
      : client_({8.0, 2000.0, ramp_in, RawHidDevice::kCommand, 0.0}) {
    client_.setConnected(true);
  }

  [[nodiscard]] bool hear(double now) {
    const test::Bytes report = emulator_.next();
    return client_.takeReport(report.data(), report.size(), now);
  }
  void wish(const Vec3& f_D, bool is_usable = true) {
    falcon_detail::RawHidWish& wish = client_.nextWish();
    Eigen::Map<Vec3>(wish.f_D.data()) = f_D;
    Eigen::Map<Eigen::Matrix3d>(wish.torques_by_force.data()) = kArm * Eigen::Matrix3d::Identity();
    wish.closures = client_.closures();
    wish.is_usable = is_usable;
    client_.passWishOn();
  }
  Given take(const HidReport& report) {
    const RawHidCommand command = test::RawHidEmulator::decode(test::bytesOf(report));
    const auto& torques = command.torques;
    const Vec3 f_D = kCount * Vec3(torques[0], torques[1], torques[2]);
    EXPECT_LE(f_D.norm(), 8.0 + 2 * kCount);
    EXPECT_LE(may_fall_ ? f_D.norm() - f_D_.norm() : (f_D - f_D_).norm(), 2.0 + 4 * kCount);
    f_D_ = f_D;
    return {f_D, command.flags, command.number};
  }
  Given give(double now) { return take(client_.giveReport(now)); }
  Given giveLast(double now) { return take(client_.giveLastReport(now)); }

  bool may_fall_ = false;  ///< the caller asks for less

  /// Each millisecond: a report, a request for full force, a command. Returns the last command.
  Given run(double from, double to) {
    Given given{};
    for (double now = from; now < to - 1e-9; now += 1e-3) {
      EXPECT_TRUE(hear(now));
      wish(kFull);
      given = give(now);
    }
    return given;
  }
  /// After `now` no report comes: four commands on the way to zero, then `flags`.
  void expectFadeFrom(double now, int flags) {
    for (int i = 1; i <= 3; ++i) {
      const Given given = give(now + i * 1e-3);
      EXPECT_EQ(given.flags, kRawHidDrive) << i;
      EXPECT_GT(given.f_D.x(), 0.0) << i;
    }
    const Given off = give(now + 4e-3);
    EXPECT_EQ(off.f_D, Vec3(Vec3::Zero()));
    EXPECT_EQ(off.flags, flags);
  }

  falcon_detail::RawHidClient client_;
  test::RawHidEmulator emulator_;
  Vec3 f_D_ = Vec3::Zero();  ///< force of the last report
};

class RawHidRampTest : public RawHidClientTest {
 protected:
  RawHidRampTest() : RawHidClientTest(0.5) {}

  /// From `now` on the device is well. The force is zero at once, and returns by the ramp.
  void expectRampFrom(double now) {
    for (int i = 0; i <= 500; ++i) {
      const double f = run(now + i * 1e-3, now + (i + 1) * 1e-3).f_D.x();
      if (i >= 5) {
        EXPECT_NEAR(f, 8.0 * i / 500.0, 0.05) << i << " ms";
      }
    }
  }
};

TEST_F(RawHidClientTest, DrivesForTwentyMillisecondsAfterAReport) {
  EXPECT_EQ(run(0.0, 0.005).f_D, kFull);  // the last report at 4 ms
  wish(kFull);
  EXPECT_EQ(give(0.023999).f_D, kFull);
  EXPECT_LT(give(0.024002).f_D.x(), 8.0);
  expectFadeFrom(0.024002, 0);
  ASSERT_TRUE(hear(0.030));
  wish(kFull);
  (void)give(0.030);  // the client has noticed the gap
  EXPECT_GT(give(0.031).f_D.x(), 0.0);
}

TEST_F(RawHidClientTest, DrivesForFiftyMillisecondsAfterACommand) {
  (void)run(0.0, 0.005);
  for (int i = 1; i <= 5; ++i) ASSERT_TRUE(hear(0.004 + 0.01 * i));
  EXPECT_EQ(give(0.053999).f_D, kFull);
  EXPECT_LT(give(0.054002).f_D.x(), 8.0);
  expectFadeFrom(0.054002, 0);
  wish(kFull);
  (void)give(0.060);
  EXPECT_GT(give(0.061).f_D.x(), 0.0) << "the same force again is a command, too";
}

TEST_F(RawHidClientTest, ADeviceThatRepeatsItselfGrowsOld) {
  (void)run(0.0, 0.004);
  const test::Bytes report = emulator_.next();
  EXPECT_TRUE(client_.takeReport(report.data(), report.size(), 0.004));
  EXPECT_TRUE(client_.takeReport(report.data(), report.size(), 0.015));
  EXPECT_EQ(give(0.023).f_D, kFull);
  expectFadeFrom(0.0245, 0);
}

TEST_F(RawHidClientTest, AForceThatTurnsRoundEndsAtOnceAndRisesByTwoNewtonsAReport) {
  (void)run(0.0, 0.01);
  may_fall_ = true;
  for (int i = 1; i <= 8; ++i) {
    ASSERT_TRUE(hear(0.01 + i * 1e-3));
    wish(-kFull);
    EXPECT_NEAR(give(0.01 + i * 1e-3).f_D.x(), std::max(-8.0, -2.0 * i), 2.0 + kCount);
  }
  EXPECT_NEAR(f_D_.x(), -8.0, kCount);
}

TEST_F(RawHidClientTest, WithoutAPositionTheForceFades) {
  (void)run(0.0, 0.01);
  wish(kFull, false);
  expectFadeFrom(0.0091, 0);
}

TEST_F(RawHidClientTest, LooksForTheIndexMarksUntilHomed) {
  EXPECT_EQ(give(0.0).flags, kRawHidHome) << "nothing is known";
  emulator_.setHomed(false);
  ASSERT_TRUE(hear(0.0));
  wish(kFull);
  const Given unhomed = give(0.001);
  EXPECT_EQ(unhomed.flags, kRawHidHome);
  EXPECT_EQ(unhomed.f_D, Vec3(Vec3::Zero()));
  emulator_.setHomed(true);
  ASSERT_TRUE(hear(0.002));
  EXPECT_EQ(give(0.003).flags, kRawHidDrive);
  (void)run(0.004, 0.014);
  emulator_.setHomed(false);
  ASSERT_TRUE(hear(0.014));
  expectFadeFrom(0.0131, kRawHidHome);
}

TEST_F(RawHidClientTest, UnpluggedItForgets) {
  EXPECT_EQ(run(0.0, 0.005).f_D, kFull);
  client_.setConnected(false);
  EXPECT_LT(give(0.005).f_D.x(), 8.0);
  f_D_.setZero();  // a device just plugged in has no force
  client_.setConnected(true);
  EXPECT_EQ(give(0.006).f_D, Vec3(Vec3::Zero()));
  ASSERT_TRUE(hear(0.006));
  EXPECT_EQ(give(0.007).f_D, Vec3(Vec3::Zero())) << "the wish is from before";
  EXPECT_GT(run(0.008, 0.010).f_D.x(), 0.0);
}

TEST_F(RawHidClientTest, CountsNumbersThatAreMissingAlsoWhereTheyWrap) {
  for (int i = 0; i < 65'530; ++i) (void)emulator_.next();
  ASSERT_TRUE(hear(0.0));
  for (int i = 0; i < 9; ++i) (void)emulator_.next();
  ASSERT_TRUE(hear(0.01));
  EXPECT_EQ(client_.lost(), 9U);
}

TEST_F(RawHidClientTest, CommandsAreNumberedAndTheLastAreTheWayToOff) {
  const std::uint16_t first = give(0.0).number;
  EXPECT_EQ(run(0.001, 0.007).f_D, kFull);
  EXPECT_EQ(giveLast(0.007).number, first + 7);
  EXPECT_GT(f_D_.x(), 0.0);
  for (int i = 1; i <= 2; ++i) EXPECT_EQ(giveLast(0.007 + i * 1e-3).flags, kRawHidDrive);
  for (int i = 3; i <= 5; ++i) {
    const Given off = giveLast(0.0071 + i * 1e-3);
    EXPECT_EQ(off.flags, 0);
    EXPECT_EQ(off.f_D, Vec3(Vec3::Zero()));
  }
}

TEST_F(RawHidRampTest, AStartAndEachFaultBeginTheRamp) {
  expectRampFrom(0.0);
  EXPECT_EQ(f_D_, kFull);
  ASSERT_TRUE(hear(0.5205)) << "the writer has not looked since 500 ms";
  expectRampFrom(0.521);
  wish(kFull, false);
  (void)give(1.022);
  expectRampFrom(1.023);
  (void)give(1.575);  // the site has paused
  expectRampFrom(1.576);
}

// Two reports between two commands: neither haptic thread nor writer sees the first.
TEST_F(RawHidRampTest, HomingThatIsLostForOneReportBeginsTheRamp) {
  expectRampFrom(0.0);
  emulator_.setHomed(false);
  ASSERT_TRUE(hear(0.5011));
  emulator_.setHomed(true);
  ASSERT_TRUE(hear(0.5012));
  expectRampFrom(0.502);
}

TEST_F(RawHidRampTest, AWishFromBeforeAFaultIsNotRendered) {
  expectRampFrom(0.0);
  emulator_.setHomed(false);
  ASSERT_TRUE(hear(0.5011));
  emulator_.setHomed(true);
  ASSERT_TRUE(hear(0.5012));
  for (int i = 2; i < 20; ++i) (void)give(0.5 + i * 1e-3);
  EXPECT_EQ(f_D_, Vec3(Vec3::Zero()));
  expectRampFrom(0.521);
}

// In any sequence of troubles take() checks bounds and rises, and each trouble ends in zero
// force. Requests change at random.
TEST_F(RawHidRampTest, NoTroubleMakesAJump) {
  constexpr std::uint64_t kSeed = 1612;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  may_fall_ = true;
  double now = 0.0;
  for (int round = 0; round < 200; ++round) {
    const int length = 1 + random.below(700), trouble = random.below(5);
    const Vec3 f_D = random.inCube(20.0);
    for (int i = 0; i < length; ++i, now += random.uniform(0.2e-3, 1.5e-3)) {
      emulator_.setHomed(trouble != 1);
      if (trouble != 2) {
        ASSERT_TRUE(hear(now));
      }
      if (trouble != 3) wish(f_D, trouble != 4);
      (void)give(now);
    }
    if (trouble != 0 && length > 400) {
      EXPECT_EQ(f_D_, Vec3(Vec3::Zero())) << trouble;
    }
  }
}

}  // namespace
}  // namespace tandem
