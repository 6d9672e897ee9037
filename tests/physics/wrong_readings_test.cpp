// A device that gives a wrong reading once, and times and settings that no host means.

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::FakeDevice;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kTick = 1e-3;  // [s]

SiteSettings makeSettings() {
  SiteSettings settings;
  settings.peers = 1;
  settings.tick_source = TickSource::kCaller;
  return settings;
}

/// A floor, and a hand that rests on it, or at a cube of 0.2 kg.
struct Scene {
  BulletRig rig{Vec3(0, 0, -9.81)};
  btRigidBody& floor = rig.addBody(rig.makeShape<btBoxShape>(btVector3(1, 1, 1)), 0.0, {0, 0, -1});
  btRigidBody& cube = rig.addCube(0.2, 0.02, Vec3(0.0, 0.0, 0.02));
  FakeDevice device;
  Site site;
  int ticks = 0;

  explicit Scene(const Vec3& hand_W) : device(hand_W), site(makeSettings(), rig.world, device) {
    device.limits.max_force = 8.0;
    site.share(cube);
  }
  /// A tick, and a step of the host of 60 Hz where one is due.
  std::uint32_t tick() {
    const std::uint32_t status = site.tick(kTick * ticks);
    if (++ticks % 17 == 0) rig.step(17 * kTick);
    return status;
  }
  void run(double duration) {
    for (int i = 0; i < duration / kTick; ++i) EXPECT_EQ(tick(), kTickOk);
  }
};

// Its way times the force was more than the tank: 1 % of the force was left for a minute.
TEST(WrongReadings, OnePositionElsewhereLeavesTheForce) {
  for (const double leap : {0.02, 0.1, 1.0, -0.1, -1.0, 1e9}) {
    Scene scene(Vec3(0.3, 0.0, 0.008));
    scene.run(0.5);
    const double force = scene.device.force_W.norm();
    ASSERT_GT(force, 3.0);
    scene.device.sample.hip.p_W.z() += leap;
    scene.tick();
    scene.device.sample.hip.p_W.z() -= leap;
    scene.run(0.5);
    EXPECT_NEAR(scene.device.force_W.norm(), force, 0.01 * force) << leap;
    EXPECT_GT(scene.site.passivity().available(), 0.01) << leap;
  }
}

// A damper pushed the cube as fast as the device said.
TEST(WrongReadings, OneVelocityHardlyMovesWhatTheHandTouches) {
  for (const double speed : {30.0, 1e3, 1e12, 1e30, 1e200}) {
    Scene scene(Vec3(-0.0295, 0.0, 0.02));
    scene.run(0.5);
    const double available = scene.site.passivity().available();
    scene.device.sample.hip.v_W.x() = speed;
    scene.tick();
    scene.device.sample.hip.v_W.x() = 0.0;
    double fastest = 0.0;
    for (int i = 0; i < 300; ++i) {
      EXPECT_EQ(scene.tick(), kTickOk) << speed;
      fastest = std::max(fastest, static_cast<double>(scene.cube.getLinearVelocity().length()));
    }
    EXPECT_LT(fastest, 0.5) << speed;
    EXPECT_LT(scene.site.passivity().available(), available + 0.02) << speed;
  }
}

// The packets that were due until then were sent one by one, for ever.
TEST(WrongReadings, ATimeThatIsNoneCountsAsTheNextTick) {
  for (const double time : {kNan, kInf, -kInf, 1e300, -1e300}) {
    Scene scene(Vec3(0.3, 0.0, 0.0));
    Scene other(Vec3(0.3, 0.0, 0.0));
    for (int i = 0; i < 20; ++i) {
      EXPECT_EQ(scene.site.tick(i % 3 == 0 ? time : kTick * i), kTickOk) << time;
      EXPECT_EQ(other.site.tick(kTick * i), kTickOk);
    }
    EXPECT_EQ(scene.site.stateHash(), other.site.stateHash()) << time;
  }
}

// With these a site hung, or had no memory left.
TEST(WrongReadings, SettingsWithoutMeasureAreRefused) {
  BulletRig rig;
  FakeDevice device;
  const auto refuses = [&](auto change) {
    SiteSettings settings = makeSettings();
    change(settings);
    EXPECT_THROW(Site(settings, rig.world, device), std::invalid_argument);
  };
  refuses([](SiteSettings& s) { s.inner_step = 1e-12; });
  refuses([](SiteSettings& s) { s.haptic_rate = 1e9; });
  refuses([](SiteSettings& s) { s.packet_rate = 1e9; });
  refuses([](SiteSettings& s) { s.host_stall = 1e7; });
  const Site good(makeSettings(), rig.world, device);
}

}  // namespace
}  // namespace tandem
