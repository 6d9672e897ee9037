#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "devices/guard_rig.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::GuardRig;
using test::kInf;

/// Draws a force; now and then one that no program should command.
Vec3 drawForce(test::Random& random) {
  const double odd[] = {std::nan(""), kInf, 1e300, -1e300};
  Vec3 force = random.direction() * random.logUniform(1e-3, 100.0);
  if (random.below(30) == 0) force[random.below(3)] = odd[random.below(4)];
  return force;
}

// Anything may fail at any time. The clamp, the limit of the rise, and zero force 100 ms after a
// fault must hold.
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
      const double rise = force.norm() - before.norm();
      ASSERT_LE(rise, rig.guard->capabilities().max_slew * 2e-3 + 1e-9);
      if (rig.guard->status().is_cut) {
        ASSERT_LE(rise, 0.0);
        ASSERT_LE(-rise, fade_slew * (rig.now - last_change) + 1e-9);
      }
      if (force != before) last_change = rig.now;
      if (force == Vec3::Zero()) last_zero = rig.now;

      // Here a fault ends once the force has been zero after it.
      if (rig.guard->status().is_cut && fault == kInf) fault = rig.now;
      if (wrote < rig.now - 0.05) fault = std::min(fault, wrote + 0.05);
      if (last_zero >= fault) fault = kInf;
      if (step <= 0.01) {
        ASSERT_LE(rig.now - fault, 0.1) << i;
      }
    }
  }
}

// Without a fault and without clipping, the force has the direction of the wanted force.
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
