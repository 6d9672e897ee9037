// Private header of the plugin: a site takes the objects of those whom it joins.
#include <array>

#include <gtest/gtest.h>

#include "plugin/src/site/peers.h"
#include "site/parts_rig.h"

namespace tandem {
namespace {

using test::kPeriod;

SiteSettings makeSettings() {
  SiteSettings settings;
  settings.membership = {true, 1.0};
  settings.coordination_mode = CoordinationMode::kAverage;
  return settings;
}

/// A site that began just now, and older ones with as many objects. Each packet has a few.
struct Newcomer {
  explicit Newcomer(int objects, std::uint32_t peers = 1)
      : others(peers), rig(objects, makeSettings()) {
    for (std::uint32_t i = 0; i < others; ++i) rig.connect(links[i], PeerId{i + 2});
  }

  /// A peer tells objects `first` to `last`, which are at `y` [m], and whether it counts us. It
  /// hears us and the first `others` peers.
  void tell(double y, int first, int last, bool counts_us, std::uint32_t peer = 2) {
    StatePacket packet = test::makePacket(PeerId{peer}, sequence++, Vec3(0, 1, 0));
    RollCall& roll = packet.roll.emplace();
    roll.age = 100.0;
    roll.heard = roll.members = SiteSet((std::uint64_t{2} << others) - 1);
    if (!counts_us) roll.members.remove(PeerId{1});
    for (int i = first; i <= last; ++i) {
      ObjectState& object = packet.objects[packet.object_count++];
      object.id = static_cast<ObjectId>(i);
      object.state.p_W = Vec3(i + 1.0, y, 0);
    }
    links[peer - 2].arrivals.push_back({packet, now});
    run(kPeriod);
  }
  void run(double duration) {
    for (const double end = now + duration - 0.5 * kPeriod; now < end; now += kPeriod) {
      rig.peers.takeInUntil(now, now);
      rig.peers.followMembers(now);
      rig.peers.followLinks(now, kPeriod, host_step);
    }
  }
  const SharedObject& object(int i) const {
    return rig.bodies.objects[static_cast<std::size_t>(i)];
  }

  double now = 0.0;
  std::uint32_t others;
  std::uint64_t sequence = 0;
  std::array<test::FakeLink, 2> links;
  test::NoHostStep host_step;
  test::PartsRig rig;
};

// Packets have room for 8 objects, so that some were told before the peer counted us.
TEST(PeerMembers, TakeOnlyPosesThatWereToldSinceTheyCount) {
  Newcomer newcomer(12);
  newcomer.tell(0.0, 0, 7, false);
  newcomer.tell(0.0, 8, 11, false);
  newcomer.tell(0.5, 0, 7, true);
  for (int i = 0; i < 8; ++i) {
    ASSERT_TRUE(newcomer.object(i).awaits_put) << i;
    EXPECT_EQ(newcomer.rig.peers.findPlace(newcomer.object(i)).p_W.y(), 0.5);
  }
  for (int i = 8; i < 12; ++i) EXPECT_FALSE(newcomer.object(i).awaits_put) << i;
  newcomer.tell(0.5, 8, 11, true);
  for (int i = 8; i < 12; ++i) EXPECT_TRUE(newcomer.object(i).awaits_put) << i;
}

// The peer was tied long ago, and its objects have moved since.
TEST(PeerMembers, TakeNoPoseOfAnEarlierMeeting) {
  Newcomer newcomer(12);
  newcomer.tell(0.0, 0, 7, true);
  newcomer.tell(0.0, 8, 11, true);
  for (SharedObject& object : newcomer.rig.bodies.objects) newcomer.rig.peers.finishPut(object);
  newcomer.tell(0.0, 0, 7, true);
  EXPECT_EQ(newcomer.rig.peers.countSites(), 2);
  newcomer.run(1.5);
  EXPECT_EQ(newcomer.rig.peers.countSites(), 1);
  newcomer.tell(0.5, 0, 3, true);
  EXPECT_EQ(newcomer.rig.peers.countSites(), 2);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(newcomer.object(i).awaits_put, i < 4) << i;
}

// A stand-in that gets more mass at its speed gets energy, which hands may have.
TEST(PeerMembers, CountTheEnergyOfAMassThatChanges) {
  Newcomer site(1, 2);
  const auto talk = [&] {
    for (int i = 0; i < 200; ++i)
      for (const std::uint32_t peer : {2u, 3u})
        if (!site.links[peer - 2].has_left) site.tell(0.0, 0, 0, true, peer);
  };
  talk();
  for (SharedObject& object : site.rig.bodies.objects) site.rig.peers.finishPut(object);
  talk();
  ASSERT_EQ(site.rig.peers.countSites(), 3);
  const BodyIndex body = *site.rig.peers[0].user.body;
  RigidState state = site.rig.island.state(body);
  state.v_W = Vec3(0.0, 0.0, 0.8);
  site.rig.island.setState(body, state);
  const double mass = site.rig.island.body(body).mass;
  const double before = site.rig.hand.energy().observer().own();
  site.links[1].has_left = true;
  site.others = 1;
  for (int i = 0; i < 3; ++i) talk();
  EXPECT_EQ(site.rig.peers.countSites(), 2);
  const double gained = site.rig.island.body(body).mass - mass;
  EXPECT_NEAR(gained, mass, 1e-12);
  const double energy = 0.5 * gained * 0.8 * 0.8;
  EXPECT_NEAR(site.rig.hand.energy().observer().own() - before, energy, 1e-12);
}

}  // namespace
}  // namespace tandem
