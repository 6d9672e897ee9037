#include "tandem/falcon/raw_hid_device.h"

#include <limits>

#include <gtest/gtest.h>

#include "devices/raw_hid_emulator.h"

namespace tandem {
namespace {

using test::comesTrue;
using test::FakeHidDevice;
using test::RawHidEmulator;
using Torques = std::array<std::int16_t, 3>;

const Vec3 kCentre_D(0.0, 0.0, 0.125);

class RawHidDeviceTest : public testing::Test {
 protected:
  RawHidDeviceTest() { emulator_.holdAt(kCentre_D); }

  static RawHidSettings settings() {
    RawHidSettings settings;
    settings.ramp_in = 0.0;
    settings.stream.first_retry = 0.001;
    return settings;
  }

  /// The device's y is W's z, its z is W's -y.
  static RawHidSettings turned() {
    RawHidSettings turned = settings();
    turned.q_WD = Quat(Eigen::AngleAxisd(std::acos(0.0), Vec3::UnitX()));
    return turned;
  }

  /// Sends a state and waits until the device has taken it.
  void tell(RawHidDevice& device, const test::Bytes& report) {
    fake_.send(report);
    ++sent_;
    ASSERT_TRUE(comesTrue([&] { return device.status().counters.reports == sent_; }));
  }

  [[nodiscard]] RawHidCommand last() const {
    return RawHidEmulator::decode(fake_.outputs().back());
  }

  /// Keeps the device fresh and commands `f_W` until a sent command meets `outcome`; stores it in
  /// `seen_`. On a busy machine the next one may be zero.
  template <typename Outcome>
  bool driveUntil(RawHidDevice& device, const Vec3& f_W, Outcome outcome) {
    return comesTrue([&] {
      tell(device, emulator_.next());
      (void)device.read(time_ += 1e-3);
      device.write(f_W);
      if (fake_.outputs().empty()) return false;
      seen_ = last();
      return outcome(seen_);
    });
  }

  FakeHidDevice fake_;
  RawHidEmulator emulator_;
  RawHidCommand seen_;
  std::uint64_t sent_ = 0;
  double time_ = 0.0;
};

bool isDriven(const RawHidCommand& command) { return command.torques != Torques{}; }

/// Force of a command's torques at the centre, in the device's frame [N].
Vec3 forceOf(const RawHidCommand& command) {
  const auto& torques = command.torques;
  const auto pose = FalconKinematics().computePose(kCentre_D);
  return kRawHidTorque * pose->dangles_dp.transpose() * Vec3(torques[0], torques[1], torques[2]);
}

/// No command exceeds 8 N or raises the force by more than 2 N, apart from rounding. Unless
/// `may_fall`, none lowers it faster either.
void expectCalm(const FakeHidDevice& fake, bool may_fall) {
  constexpr double kMost = 2.1;  // one encoder count turns 8 N by less than 1 %
  Vec3 last = Vec3::Zero();
  for (const test::Bytes& output : fake.outputs()) {
    const Vec3 f_D = forceOf(RawHidEmulator::decode(output));
    EXPECT_LE(f_D.norm(), 8.01);
    EXPECT_LE(may_fall ? f_D.norm() - last.norm() : (f_D - last).norm(), kMost);
    last = f_D;
  }
}

TEST_F(RawHidDeviceTest, TheGripIsWhereTheLegsSay) {
  RawHidDevice device(fake_.opener(), turned());
  EXPECT_FALSE(device.read(0.0).valid) << "nothing has come";
  emulator_.holdAt(kCentre_D + Vec3(0.01, 0.0, 0.02));
  tell(device, emulator_.next());
  const DeviceSample sample = device.read(0.001);
  ASSERT_TRUE(sample.valid);
  // One count of each of the three legs is at most 48 um.
  EXPECT_LT((sample.hip.p_W - Vec3(0.01, -0.02, 0.0)).norm(), 50e-6);
  EXPECT_EQ(sample.hip.v_W, Vec3(Vec3::Zero())) << "one position is no velocity";
}

TEST_F(RawHidDeviceTest, TheVelocityIsByTheDevicesClock) {
  RawHidDevice device(fake_.opener(), turned());
  DeviceSample sample;
  // A busy machine may leave gaps of 20 ms; after these the velocity estimate restarts.
  for (int round = 0, gaps = 1; gaps > 0 && round < 100; ++round) {
    gaps = round == 0 ? 1 : 0;
    for (int i = 0; i < 200; ++i) {
      emulator_.holdAt(kCentre_D + Vec3(0.0, 1e-4 * (i - 100), 0.0));
      tell(device, emulator_.next(2000));   // 0.05 m/s
      sample = device.read(time_ += 1e-3);  // the site's clock runs at another speed
      if (!sample.valid) ++gaps;
    }
  }
  ASSERT_TRUE(sample.valid);
  // A count is at most 48 um: in windows of 8 ms the usual estimator is off by some mm/s.
  EXPECT_LT((sample.hip.v_W - Vec3(0.0, 0.0, 0.05)).norm(), 0.02);
}

TEST_F(RawHidDeviceTest, AForceArrivesAsTheTorquesThatMakeIt) {
  RawHidDevice device(fake_.opener(), turned());
  const auto isWhole = [](const RawHidCommand& c) {
    return std::abs(forceOf(c).norm() - std::sqrt(14.0)) < 0.02;
  };
  ASSERT_TRUE(driveUntil(device, Vec3(1.0, -2.0, 3.0), isWhole));
  const auto pose = FalconKinematics().computePose(kCentre_D);
  const Vec3 expected = *computeTorques(*pose, Vec3(1.0, 3.0, 2.0)) / kRawHidTorque;
  for (int i = 0; i < 3; ++i)  // one encoder count turns the force by less than 1 %
    EXPECT_NEAR(seen_.torques[static_cast<std::size_t>(i)], expected[i],
                0.01 * expected.cwiseAbs().maxCoeff());
  EXPECT_EQ(seen_.flags, kRawHidDrive);
}

TEST_F(RawHidDeviceTest, NoForceUntilItIsHomed) {
  emulator_.setHomed(false);
  RawHidDevice device(fake_.opener(), settings());
  ASSERT_TRUE(
      driveUntil(device, Vec3(5, 0, 0), [](const RawHidCommand& c) { return c.number > 20; }));
  EXPECT_FALSE(device.read(time_).valid);
  for (const test::Bytes& output : fake_.outputs()) {
    EXPECT_EQ(RawHidEmulator::decode(output).torques, Torques{});
    EXPECT_EQ(RawHidEmulator::decode(output).flags, kRawHidHome);
  }
  emulator_.setHomed(true);
  EXPECT_TRUE(driveUntil(device, Vec3(5, 0, 0), &isDriven));
}

TEST_F(RawHidDeviceTest, AnOldReplyIsNotValidInTheSitesTime) {
  RawHidDevice device(fake_.opener(), settings());
  const test::Bytes report = emulator_.next();
  tell(device, report);
  EXPECT_TRUE(device.read(0.0).valid);
  EXPECT_TRUE(device.read(0.02).valid);
  EXPECT_FALSE(device.read(0.0201).valid);
  tell(device, report);
  EXPECT_FALSE(device.read(0.021).valid) << "a device that repeats itself is not fresh";
  double now = 0.021;
  EXPECT_TRUE(comesTrue([&] {
    tell(device, emulator_.next());
    return device.read(now += 0.001).valid;
  }));
}

// One sample is invalid after a report that is not homed or comes late, even if the newest is good.
TEST_F(RawHidDeviceTest, OneSampleIsNotValidAfterAFaultThatItDoesNotShow) {
  RawHidDevice device(fake_.opener(), settings());
  tell(device, emulator_.next());
  ASSERT_TRUE(device.read(0.0).valid);
  emulator_.setHomed(false);
  tell(device, emulator_.next());
  emulator_.setHomed(true);
  tell(device, emulator_.next());
  EXPECT_FALSE(device.read(0.001).valid);
  const DeviceSample sample = device.read(0.002);
  EXPECT_TRUE(sample.valid);
  EXPECT_EQ(sample.hip.v_W, Vec3(Vec3::Zero()));
}

// A position computed from these counts would look valid.
TEST_F(RawHidDeviceTest, ArmsAWholeTurnOffAreNoPosition) {
  for (std::size_t leg = 0; leg < 3; ++leg)
    for (const int turn : {-9880, 9880}) {
      RawHidDevice device(fake_.opener(), settings());
      emulator_.holdAt(kCentre_D);
      emulator_.turn(leg, turn);
      tell(device, emulator_.next());
      EXPECT_FALSE(device.read(0.0).valid) << leg << " by " << turn;
      sent_ = 0;
    }
}

TEST_F(RawHidDeviceTest, TheWriterGoesToZeroWhenRepliesOrTicksEnd) {
  RawHidDevice device(fake_.opener(), settings());
  const auto isZero = [](const RawHidCommand& c) { return !isDriven(c) && c.flags == 0; };
  ASSERT_TRUE(driveUntil(device, Vec3(5, 0, 0), &isDriven));
  // Ticks go on, and the device is silent. Only the writing thread watches it.
  EXPECT_TRUE(comesTrue([&] {
    device.write(Vec3(5, 0, 0));
    return isZero(last());
  }));
  ASSERT_TRUE(driveUntil(device, Vec3(5, 0, 0), &isDriven));
  // The device goes on, and the ticks have ended.
  EXPECT_TRUE(comesTrue([&] {
    fake_.send(emulator_.next());
    return isZero(last());
  }));
}

TEST_F(RawHidDeviceTest, AForceIsClampedAndNeverNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  RawHidDevice device(fake_.opener(), settings());
  EXPECT_EQ(device.capabilities().max_force, 8.0);
  const auto isFull = [](const RawHidCommand& c) { return forceOf(c).norm() > 7.95; };
  for (const Vec3& large : {Vec3(8, 0, 0), Vec3(-100, 0, 0), Vec3(0, 1e300, 0)})
    ASSERT_TRUE(driveUntil(device, large, [&](const RawHidCommand& c) {
      return isFull(c) && forceOf(c).dot(large) > 0.0;
    }));
  for (const Vec3& bad : {Vec3(kNan, 0, 0), Vec3(0, 0, std::numeric_limits<double>::infinity())}) {
    ASSERT_TRUE(driveUntil(device, Vec3(8, 0, 0), isFull));
    EXPECT_TRUE(driveUntil(device, bad, [](const auto& c) { return c.torques == Torques{}; }));
  }
  expectCalm(fake_, true);
}

TEST_F(RawHidDeviceTest, HomingThatGoesAndComesChangesTheForceByTwoNewtonsAReport) {
  RawHidDevice device(fake_.opener(), settings());
  const auto isFull = [](const RawHidCommand& c) { return forceOf(c).norm() > 7.95; };
  for (int round = 0; round < 3; ++round) {
    ASSERT_TRUE(driveUntil(device, Vec3(0, 0, 8), isFull));
    emulator_.setHomed(false);
    ASSERT_TRUE(driveUntil(device, Vec3(0, 0, 8),
                           [](const RawHidCommand& c) { return c.flags == kRawHidHome; }));
    emulator_.setHomed(true);
  }
  expectCalm(fake_, false);
}

TEST_F(RawHidDeviceTest, AfterTheStartThereIsARamp) {
  RawHidSettings slow = settings();
  slow.ramp_in = 3600.0;
  RawHidDevice device(fake_.opener(), slow);
  ASSERT_TRUE(driveUntil(device, Vec3(0, 0, 8), &isDriven));
  EXPECT_LT(forceOf(seen_).norm(), 0.08) << "36 s of it have not gone yet";
}

TEST_F(RawHidDeviceTest, TheLastWordIsMotorsOff) {
  {
    RawHidDevice device(fake_.opener(), settings());
    ASSERT_TRUE(driveUntil(device, Vec3(5, 0, 0),
                           [](const RawHidCommand& c) { return forceOf(c).norm() > 4.9; }));
  }
  EXPECT_EQ(last().torques, Torques{});
  EXPECT_EQ(last().flags, 0);
  expectCalm(fake_, false);
}

TEST_F(RawHidDeviceTest, UnpluggedItIsNotValidAndBeginsAnew) {
  RawHidDevice device(fake_.opener(), settings());
  ASSERT_TRUE(driveUntil(device, Vec3(5, 0, 0), &isDriven));
  fake_.setPluggedIn(false);
  ASSERT_TRUE(comesTrue([&] { return device.status().trouble == "the fake is not plugged in"; }));
  EXPECT_FALSE(device.read(time_).valid);
  const std::size_t before = fake_.outputs().size();
  fake_.setPluggedIn(true);
  ASSERT_TRUE(comesTrue([&] { return fake_.outputs().size() > before; }));
  EXPECT_EQ(RawHidEmulator::decode(fake_.outputs()[before]).torques, Torques{});
  EXPECT_FALSE(device.read(time_).valid) << "the old state is forgotten";
  sent_ = device.status().counters.reports;
  EXPECT_TRUE(driveUntil(device, Vec3(5, 0, 0), &isDriven));
}

TEST_F(RawHidDeviceTest, CountsReportsThatAreLostOrWrong) {
  RawHidDevice device(fake_.opener(), settings());
  tell(device, emulator_.next());
  (void)emulator_.next();
  (void)emulator_.next();
  tell(device, emulator_.next());
  test::Bytes wrong = emulator_.next();
  wrong[5] ^= 1;
  tell(device, wrong);
  EXPECT_EQ(device.status().lost, 2U);
  EXPECT_EQ(device.status().counters.refused, 1U);
}

TEST_F(RawHidDeviceTest, RefusesSettingsOutOfRange) {
  const auto expectRefused = [&](auto spoil) {
    RawHidSettings bad = settings();
    spoil(bad);
    EXPECT_THROW((void)RawHidDevice(fake_.opener(), bad), std::invalid_argument);
  };
  using S = RawHidSettings;
  expectRefused([](S& s) { s.max_force = 8.1; });
  expectRefused([](S& s) { s.max_force = 0.0; });
  expectRefused([](S& s) { s.ramp_in = -1.0; });
  expectRefused([](S& s) { s.origin_D.x() = std::numeric_limits<double>::infinity(); });
  expectRefused([](S& s) { s.q_WD = Quat(0, 0, 0, 0); });
  expectRefused([](S& s) { s.stream.write_period = 0.0; });
  expectRefused([](S& s) { s.stream.write_period = 0.02; });
}

}  // namespace
}  // namespace tandem
