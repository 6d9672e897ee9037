#include "tandem/falcon/guarded_device.h"

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "devices/told_device.h"
#include "support/random.h"

namespace tandem {
namespace {

constexpr double kPeriod = 1e-3;  // [s]
constexpr double kInf = std::numeric_limits<double>::infinity();

/// A guard over a told device, tick by tick.
class GuardRig {
 public:
  explicit GuardRig(const GuardSettings& settings = {}, const DeviceCapabilities& device = {})
      : script{device},
        guard(std::make_unique<GuardedDevice>(std::make_unique<test::ToldDevice>(script),
                                              settings)) {}

  /// Reads a period later and writes; gives the device's force.
  Vec3 tick(const Vec3& wanted) {
    now += kPeriod;
    (void)guard->read(now);
    guard->write(wanted);
    return script.force;
  }
  void tickFor(double duration, const Vec3& wanted) {
    const int ticks = static_cast<int>(std::lround(duration / kPeriod));
    for (int i = 0; i < ticks; ++i) (void)tick(wanted);
  }
  /// To where the ramp is over.
  void warmUp(const Vec3& wanted) { tickFor(0.6, wanted); }
  [[nodiscard]] std::uint64_t cuts(GuardCut reason) const {
    return guard->status().cuts[static_cast<std::size_t>(reason)];
  }

  test::DeviceScript script;
  std::unique_ptr<GuardedDevice> guard;
  double now = 10.0;  // [s]
};

const Vec3 kPush(0.0, 3.0, -4.0);  // 5 N

TEST(GuardedDevice, GivesNothingBeforeAPositionAndThenRampsIn) {
  GuardRig rig;
  EXPECT_EQ(rig.script.force, Vec3::Zero());
  rig.guard->write(kPush);
  EXPECT_EQ(rig.script.force, Vec3::Zero());
  rig.script.sample.valid = false;
  rig.tickFor(1.0, kPush);
  EXPECT_EQ(rig.script.force, Vec3::Zero());
  EXPECT_EQ(rig.cuts(GuardCut::kNotValid), 0u);  // it has been so from the start

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

TEST(GuardedDevice, ChangesNoFasterThanItsSlewCountedInTime) {
  GuardRig rig;
  rig.warmUp(Vec3::Zero());
  EXPECT_NEAR(rig.tick(kPush).norm(), 2.0, 1e-9);
  rig.guard->write(kPush);  // again in the same tick: no time has passed
  EXPECT_NEAR(rig.script.force.norm(), 2.0, 1e-9);
  rig.now += 0.02;  // a late tick counts for two periods
  EXPECT_NEAR(rig.tick(-10.0 * kPush).norm(), 2.0, 1e-9);
  EXPECT_LT(rig.script.force.dot(kPush), 0.0);
  EXPECT_EQ(rig.guard->status().slewed, 3u);
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

/// A force that no program should ask for, now and then.
Vec3 drawForce(test::Random& random) {
  const double odd[] = {std::nan(""), kInf, 1e300, -1e300};
  Vec3 force = random.direction() * random.logUniform(1e-3, 100.0);
  if (random.below(30) == 0) force[random.below(3)] = odd[random.below(4)];
  return force;
}

TEST(GuardedDevice, HearsOfItsDeadManFromAnotherThread) {
  GuardRig rig;
  std::thread other([&] {
    for (int i = 0; i < 1000; ++i) rig.guard->holdDeadMan(i % 2 == 0);
  });
  rig.tickFor(1.0, kPush);
  other.join();
  rig.tickFor(0.01, kPush);
  EXPECT_EQ(rig.script.force, Vec3::Zero());  // at last it was let go
  EXPECT_GE(rig.cuts(GuardCut::kDeadMan), 1u);
}

// Anything may go wrong at any time. Held to: the clamp, the slew, and zero 100 ms after a fault.
TEST(GuardedDevice, HoldsItsPromisesWhateverHappens) {
  constexpr std::uint64_t kSeed = 31;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  for (int run = 0; run < 60; ++run) {
    GuardSettings settings;
    settings.max_force = random.logUniform(0.5, 20.0);
    settings.max_slew = random.logUniform(10.0, 1e4);
    settings.ramp = random.below(3) == 0 ? 0.0 : random.uniform(0.0, 1.0);
    DeviceCapabilities device;
    if (random.below(2) == 0) device.max_slew = random.logUniform(10.0, 1e4);
    GuardRig rig(settings, device);
    const double max_force = rig.guard->capabilities().max_force;
    const double fade_slew = std::max(rig.guard->capabilities().max_slew, max_force / 0.03);
    double last_zero = rig.now, last_change = rig.now, fault = kInf, wrote = rig.now;
    bool is_quiet = false;
    for (int i = 0; i < 20000; ++i) {
      const Vec3 before = rig.script.force;
      const double step =
          random.below(300) == 0 ? random.uniform(0.0, 0.3) : random.uniform(0.0, 0.01);
      rig.now += step;
      if (random.below(500) == 0) rig.script.sample.valid = !rig.script.sample.valid;
      if (random.below(500) == 0) rig.guard->holdDeadMan(random.below(4) != 0);
      if (random.below(500) == 0) is_quiet = !is_quiet;
      (void)rig.guard->read(rig.now);
      if (!is_quiet) {
        rig.guard->write(drawForce(random));
        wrote = rig.now;
      }

      const Vec3 force = rig.script.force;
      ASSERT_TRUE(force.allFinite());
      ASSERT_LE(force.norm(), max_force * (1.0 + 1e-12));
      ASSERT_LE((force - before).norm(), fade_slew * (rig.now - last_change) + 1e-9);
      if (!rig.guard->status().is_cut) {
        ASSERT_LE((force - before).norm(), rig.guard->capabilities().max_slew * 2e-3 + 1e-9);
      }
      if (force != before) last_change = rig.now;
      if (force == Vec3::Zero()) last_zero = rig.now;

      // A fault is over for this test once the force has been zero after it.
      if (rig.guard->status().is_cut && fault == kInf) fault = rig.now;
      if (wrote < rig.now - 0.05) fault = std::min(fault, wrote + 0.05);
      if (last_zero >= fault) fault = kInf;
      if (step <= 0.01) {
        ASSERT_LE(rig.now - fault, 0.1) << i;
      }
    }
  }
}

// While nothing is wrong and nothing is too fast, the direction is that of the wanted force.
TEST(GuardedDevice, KeepsTheDirection) {
  constexpr std::uint64_t kSeed = 32;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  for (int run = 0; run < 100; ++run) {
    GuardRig rig({8.0, 2000.0, random.uniform(0.0, 0.2)});
    const Vec3 wanted = random.direction() * random.logUniform(0.1, 1e6);
    for (int i = 0; i < 300; ++i) {
      const Vec3 force = rig.tick(wanted);
      ASSERT_LT(force.cross(wanted.normalized()).norm(), 1e-12);
      ASSERT_GE(force.dot(wanted), 0.0);
    }
    EXPECT_NEAR(rig.script.force.norm(), std::min(8.0, wanted.norm()), 1e-9);
  }
}

}  // namespace
}  // namespace tandem
