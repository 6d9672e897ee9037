// A peer that has the key and sends anything: force, rise, energy and targets keep their bounds.

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tandem/coordination/passivity_observer.h"
#include "tandem/coordination/scheme.h"
#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "support/fakes.h"
#include "support/metered_device.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::FakeLink;

constexpr double kPeriod = 1e-3;
constexpr PeerId kLiar{2};

SimulatedDeviceSettings makeHandle() {
  SimulatedDeviceSettings handle;
  handle.start_W = Vec3(-0.03, 0, 0);
  return handle;
}

/// A passive hand at a shared cube, with a simulated device as it is by default.
struct Victim {
  BulletRig rig;
  SimulatedDevice handle{makeHandle(), makeConstantHand(Vec3::Zero())};
  test::MeteredDevice device{handle};
  FakeLink link;
  std::unique_ptr<Site> site;
  double most_got = 0.0, most_force = 0.0, most_rise = 0.0;

  explicit Victim(const char* scheme) {
    SiteSettings settings;
    settings.tick_source = TickSource::kCaller;
    settings.scheme = &findScheme(scheme);
    site = std::make_unique<Site>(settings, rig.world, device);
    site->share(rig.addCube(0.2));
    site->connect(kLiar, link, Vec3(0.03, 0, 0));
  }
  void tick(double now, long number) {
    const Vec3 force_W = site->force();
    site->tick(now);
    most_got = std::max(most_got, -device.putIn());
    most_force = std::max(most_force, site->force().norm());
    most_rise = std::max(most_rise, site->force().norm() - force_W.norm());
    if (number % 4 == 3) rig.step(4.0 * kPeriod);
  }
};

/// Any sane state: near or far, at rest or fast, with grants of any size.
StatePacket drawLie(test::Random& random, std::uint64_t sequence, double now) {
  const auto far = [&]() -> Vec3 { return random.direction() * random.logUniform(1e-3, 1e3); };
  StatePacket packet;
  packet.sender = kLiar;
  packet.sequence = sequence;
  packet.time = random.below(4) == 0 ? random.uniform(0.0, 1e6) : now;
  packet.user = {far(), far()};
  if (random.below(5) > 0) packet.energy = {random.logUniform(1e-6, 1e9), -1e9};
  packet.object_count = 1;
  packet.objects[0] = {0, {far(), Quat::Identity(), far(), far()}};
  if (random.below(2) > 0)
    packet.objects[0].epoch = {static_cast<std::uint32_t>(random.below(4)) * 0x60000000u,
                               PeerId{static_cast<std::uint32_t>(random.below(4))}};
  packet.objects[0].state.q_WB =
      Quat(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), 0.5).normalized();
  return packet;
}

class LyingPeer : public ::testing::TestWithParam<const char*> {};

TEST_P(LyingPeer, HasBoundsOfForceRiseAndEnergy) {
  constexpr double kDuration = 10.0;
  const PassivitySettings passivity;
  for (const std::uint64_t seed : {45u, 46u, 47u, 48u}) {
    SCOPED_TRACE(seed);
    test::Random random(seed);
    Victim victim(GetParam());
    std::uint64_t sequence = 0;
    for (long i = 0; i < std::lround(kDuration / kPeriod); ++i) {
      const double now = static_cast<double>(i) * kPeriod;
      if (i % 4 == 0) victim.link.arrivals.push_back({drawLie(random, sequence++, now), now});
      victim.tick(now, i);
    }
    EXPECT_TRUE(isFinite(victim.site->object(0)));
    EXPECT_LE(victim.most_force, SimulatedDeviceSettings{}.max_force * (1.0 + 1e-12));
    EXPECT_LE(victim.most_rise, SiteSettings{}.max_slew * kPeriod + 1e-9);
    EXPECT_LE(victim.most_got,
              passivity.tank + passivity.most + passivity.power * kDuration + 1e-3);
    EXPECT_GT(victim.site->counters().peer_jumps, 0u);
  }
}

// A peer that says that it needs everything gets nothing of this hand's tank.
TEST_P(LyingPeer, CannotMuteTheHand) {
  Victim victim(GetParam());
  for (long i = 0; i < 2000; ++i) {
    const double now = static_cast<double>(i) * kPeriod;
    StatePacket packet = test::makePacket(kLiar, static_cast<std::uint64_t>(i), Vec3(0.03, 0, 0));
    packet.energy = {0.0, -1e9};
    victim.link.arrivals.push_back({packet, now});
    victim.tick(now, i);
  }
  EXPECT_GE(victim.site->passivity().available(), PassivitySettings{}.tank - 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Schemes, LyingPeer,
                         ::testing::Values("virtual_coupling", "kinematic_proxy",
                                           "remote_dynamic_proxy"));

}  // namespace
}  // namespace tandem
