// There are more shared objects than fit one packet: they take turns, and untouched objects cost
// nothing.

#include <cmath>
#include <memory>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "tandem/coordination/island_counters.h"
#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::FakeDevice;
using test::FakeLink;
using test::makePacket;

constexpr double kPeriod = 1e-3;  // haptic period [s]
constexpr int kTicksPerStep = 4;  // ticks of a host step: 250 Hz
constexpr double kHostStep = kTicksPerStep * kPeriod;
constexpr double kHalf = 0.02, kRadius = 0.01;  // cubes and device [m]
constexpr double kMass = 0.1;                   // mass of this copy of a cube [kg]
constexpr PeerId kRemote{2};

/// Cubes side by side in space, moved only by the device.
struct Crowd {
  BulletRig host;
  FakeDevice device{Vec3(0, 0, 1)};
  FakeLink link{100'000};
  std::vector<btRigidBody*> cubes;
  std::unique_ptr<Site> site;
  std::uint64_t ticks = 0;

  explicit Crowd(int count) {
    SiteSettings settings;
    settings.coordination = {0.0, 0.0};
    settings.tick_source = TickSource::kCaller;
    settings.host_step = kHostStep;
    settings.packet_rate = 1.0 / kPeriod;
    site = std::make_unique<Site>(settings, host.world, device);
    for (int i = 0; i < count; ++i) {
      cubes.push_back(&host.addCube(2 * kMass, kHalf, Vec3(0.1 * (i % 16), 0.1 * (i / 16), 0)));
      site->share(*cubes.back());
    }
    site->connect(kRemote, link, Vec3(0, 0, 2));
  }
  ~Crowd() { site.reset(); }
  void tick() { site->tick(static_cast<double>(ticks++) * kPeriod); }
  void hostStep() {
    for (int i = 0; i < kTicksPerStep; ++i) tick();
    host.step(kHostStep);
  }
  [[nodiscard]] std::set<ObjectId> lastSent() const {
    std::set<ObjectId> ids;
    const StatePacket& packet = link.sent.back();
    for (std::uint32_t i = 0; i < packet.object_count; ++i) ids.insert(packet.objects[i].id);
    EXPECT_EQ(ids.size(), packet.object_count);
    return ids;
  }
};

TEST(ManyObjects, EightOrLessAreInEveryPacket) {
  Crowd crowd(8);
  for (int i = 0; i < 5; ++i) {
    crowd.tick();
    EXPECT_EQ(crowd.lastSent(), (std::set<ObjectId>{0, 1, 2, 3, 4, 5, 6, 7}));
    for (ObjectId id = 0; id < 8; ++id) EXPECT_EQ(crowd.link.sent.back().objects[id].id, id);
  }
}

TEST(ManyObjects, TakeTurnsAndWhatMovesGoesFirst) {
  Crowd crowd(64);
  std::set<ObjectId> seen;
  // Each counts as moved until it is sent first: a packet takes seven of these and one in turn.
  for (int i = 0; i < 10; ++i) {
    crowd.tick();
    seen.merge(crowd.lastSent());
  }
  EXPECT_EQ(seen.size(), 64u);
  while (crowd.ticks % kTicksPerStep != 0) crowd.tick();
  crowd.host.step(kHostStep);
  for (const ObjectId id : {60u, 17u}) crowd.cubes[id]->setLinearVelocity(btVector3(0, 0, 1));
  crowd.hostStep();  // the island learns of it
  seen.clear();
  for (int i = 0; i < 12; ++i) {
    crowd.tick();
    const std::set<ObjectId> sent = crowd.lastSent();
    EXPECT_EQ(sent.count(60) + sent.count(17), 2u);
    EXPECT_EQ(sent.size(), 8u);
    seen.insert(sent.begin(), sent.end());
  }
  EXPECT_EQ(seen.size(), 64u);  // the still ones took turns in the six other places
}

TEST(ManyObjects, NewestWinsForEachByItself) {
  Crowd crowd(2);
  const auto put = [&](std::uint64_t sequence, ObjectId id) {
    StatePacket packet = makePacket(kRemote, sequence, Vec3(0, 0, 2));
    packet.object_count = 1;
    packet.objects[0].id = id;
    crowd.link.arrivals.push_back({packet, static_cast<double>(crowd.ticks) * kPeriod});
    crowd.tick();
  };
  put(5, 0);
  put(3, 1);  // overtaken by a later packet, but the newest of object 1
  EXPECT_EQ(crowd.site->counters().packets_taken, 2u);
  EXPECT_EQ(crowd.site->latest(0).sequence, 5u);
  put(4, 0), put(3, 1), put(2, 1), put(5, 0);
  EXPECT_EQ(crowd.site->counters().packets_stale, 4u);
}

TEST(ManyObjects, CostTheIslandNothingUntouched) {
  Crowd crowd(256);
  // The device comes down on the first cube, and presses it to and fro.
  crowd.device.sample.hip.p_W = Vec3(0, 0, kHalf + kRadius);
  const auto press = [&](int steps) {
    for (int i = 0; i < steps; ++i) {
      crowd.device.sample.hip.p_W.z() = kHalf + kRadius + 5e-4 * std::sin(0.3 * i);
      crowd.hostStep();
    }
  };
  press(50);
  const IslandCounters before = crowd.site->islandCounters();
  const SiteCounters site_before = crowd.site->counters();
  press(50);
  const IslandCounters& after = crowd.site->islandCounters();
  const auto busy = (after.advances - after.asleep) - (before.advances - before.asleep);
  EXPECT_GE(busy, 200u);
  EXPECT_EQ(after.asleep_bodies - before.asleep_bodies, 255u * busy);
  EXPECT_LE(
      after.exact_bodies + after.integrated_bodies - before.exact_bodies - before.integrated_bodies,
      2u * busy);
  EXPECT_LE(after.contact_searches + after.contact_searches_skipped - before.contact_searches -
                before.contact_searches_skipped,
            10u * busy);
  EXPECT_LE(crowd.site->counters().bodies_handed_off - site_before.bodies_handed_off, 2u * 50u);
}

TEST(ManyObjects, NoMoreThanTheMost) {
  Crowd crowd(kMaxSharedObjects);
  EXPECT_THROW(crowd.site->share(crowd.host.addCube(1, kHalf, Vec3(5, 5, 5))), Error);
  for (int i = 0; i < 20; ++i) crowd.hostStep();
  const SiteCounters before = crowd.site->counters();
  for (int i = 0; i < 20; ++i) crowd.hostStep();
  EXPECT_EQ(crowd.site->counters().host_steps_skipped - before.host_steps_skipped, 20u);
  EXPECT_EQ(crowd.site->counters().bodies_handed_off, before.bodies_handed_off);
}

}  // namespace
}  // namespace tandem
