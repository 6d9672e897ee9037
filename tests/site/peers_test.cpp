// Private header of the plugin: what packets and silence do to a remote user's representation.
#include "plugin/src/site/peers.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "site/parts_rig.h"

namespace tandem {
namespace {

using test::kPeriod;

/// Peer 2 with shared objects, and packets that the test makes.
struct Conversation {
  explicit Conversation(int objects = 2) : rig(objects), peer(rig.connect(link)) {}

  StatePacket makePacket(std::uint64_t sequence) const {
    return test::makePacket(PeerId{2}, sequence, Vec3(0, 1, 0));
  }
  static void addObject(StatePacket& packet, ObjectId id, const Vec3& p_W,
                        const Vec3& v_W = Vec3::Zero()) {
    ObjectState& object = packet.objects[packet.object_count++];
    object.id = id;
    object.state.p_W = p_W;
    object.state.v_W = v_W;
  }
  void arrive(const StatePacket& packet, double time) {
    link.arrivals.push_back({packet, time});
    rig.peers.takeInUntil(time, time);
  }
  void follow(double now) { rig.peers.followLinks(now, kPeriod, host_step); }
  const RigidState& target(int object) const {
    return rig.island.target(peer.ties[static_cast<std::size_t>(object)].coupler);
  }
  double share(int object) const {
    return rig.island.couplerShare(peer.ties[static_cast<std::size_t>(object)].coupler);
  }

  test::FakeLink link;
  test::NoHostStep host_step;
  test::PartsRig rig;
  Peer& peer;
};

TEST(Peers, IgnoreAnOlderStateOfOneObjectOnly) {
  Conversation talk;
  StatePacket newer = talk.makePacket(5), older = talk.makePacket(4), oldest = talk.makePacket(3);
  newer.user.p_W = Vec3(0, 2, 0);
  Conversation::addObject(newer, 0, Vec3(1.03, 0, 0));
  Conversation::addObject(older, 0, Vec3(1.02, 0, 0));
  Conversation::addObject(older, 1, Vec3(2.02, 0, 0));
  Conversation::addObject(oldest, 0, Vec3(1.01, 0, 0));
  Conversation::addObject(oldest, 1, Vec3(2.01, 0, 0));
  talk.arrive(newer, 0.01);
  talk.arrive(older, 0.011);
  talk.arrive(oldest, 0.012);
  EXPECT_EQ(talk.target(0).p_W, Vec3(1.03, 0, 0));
  EXPECT_EQ(talk.target(1).p_W, Vec3(2.02, 0, 0));
  EXPECT_EQ(talk.peer.latest.sequence, 5u);
  EXPECT_EQ(talk.rig.island.target(*talk.peer.user.coupler).p_W, Vec3(0, 2, 0));
  EXPECT_EQ(talk.rig.log.counters.packets_taken, 2u);
  EXPECT_EQ(talk.rig.log.counters.packets_stale, 1u);
}

// The first state that a peer tells is where its copy is, and ours is led there.
TEST(Peers, LeadOurCopyToOneThatIsFoundElsewhere) {
  Conversation talk;
  StatePacket first = talk.makePacket(0);
  Conversation::addObject(first, 0, Vec3(1.5, 0, 0));
  talk.arrive(first, 0.01);
  EXPECT_EQ(talk.target(0).p_W, Vec3(1, 0, 0));
  EXPECT_TRUE(talk.peer.is_detouring);
}

TEST(Peers, RefusePacketsOfOthersAndWithoutNumbers) {
  Conversation talk;
  StatePacket other = talk.makePacket(0), wrong = talk.makePacket(1);
  other.sender = PeerId{3};
  wrong.user.v_W.y() = std::numeric_limits<double>::quiet_NaN();
  talk.rig.log.startTick();
  talk.arrive(other, 0.01);
  talk.arrive(wrong, 0.01);
  EXPECT_EQ(talk.rig.log.counters.packets_refused, 2u);
  EXPECT_FALSE(talk.peer.is_heard);
  EXPECT_EQ(talk.rig.log.endTick(), kPacketRefused);
}

TEST(Peers, TakePacketsAtTheirMoment) {
  Conversation talk;
  talk.link.arrivals.push_back({talk.makePacket(0), 0.0103});
  talk.link.arrivals.push_back({talk.makePacket(1), 0.0107});
  EXPECT_EQ(talk.rig.peers.nextArrival(0.01, 0.011), 0.0103);
  talk.rig.peers.takeInUntil(0.0103, 0.01);
  EXPECT_EQ(talk.peer.latest.sequence, 0u);
  EXPECT_EQ(talk.rig.peers.nextArrival(0.01, 0.011), 0.0107);
  // A packet of the past acts at the start of the tick.
  EXPECT_EQ(talk.rig.peers.nextArrival(0.02, 0.021), 0.02);
}

// Velocities of targets fall by exp(-(age - 25 ms) / 20 ms) and do not rise before the object is
// heard.
TEST(Peers, ASlowedTargetNeverSpeedsUpBeforeItIsHeard) {
  const Vec3 v_W(0.3, 0, -0.2);
  Conversation talk;
  StatePacket first = talk.makePacket(0);
  Conversation::addObject(first, 0, Vec3(1.0, 0, 0), v_W);
  talk.arrive(first, 0.0);
  double slowest = 1.0;
  for (int tick = 0; tick <= 80; ++tick) {
    const double now = tick * kPeriod;
    talk.follow(now);
    slowest = now < 0.026 ? 1.0 : std::exp(-(now - 0.025) / 0.02);
    ASSERT_LT((talk.target(0).v_W - slowest * v_W).norm(), 1e-12) << tick;
  }
  // The user is heard again, object 0 is not.
  talk.arrive(talk.makePacket(1), 0.0805);
  for (int tick = 81; tick <= 100; ++tick) {
    talk.follow(tick * kPeriod);
    ASSERT_LT((talk.target(0).v_W - slowest * v_W).norm(), 1e-12) << tick;
  }
  StatePacket again = talk.makePacket(2);
  Conversation::addObject(again, 0, Vec3(1.0, 0, 0), v_W);
  talk.arrive(again, 0.1005);
  EXPECT_EQ(talk.target(0).v_W, v_W);
  talk.follow(0.101);
  EXPECT_EQ(talk.target(0).v_W, v_W);
}

TEST(Peers, TiesOfALostPeerActAgainOnceTheyAreRenewed) {
  Conversation talk;
  StatePacket first = talk.makePacket(10);
  Conversation::addObject(first, 0, Vec3(1.0, 0, 0));
  Conversation::addObject(first, 1, Vec3(2.0, 0, 0));
  talk.arrive(first, 0.0);
  for (int tick = 0; tick < 300; ++tick) talk.follow(tick * kPeriod);
  EXPECT_EQ(talk.peer.health.state(), LinkState::kLost);
  EXPECT_EQ(talk.share(0), 0.0);
  EXPECT_TRUE(talk.rig.island.isGhost(*talk.peer.user.body));
  EXPECT_EQ(talk.rig.log.counters.links_lost, 1u);

  // It comes back with object 0; a packet from before has object 1.
  StatePacket back = talk.makePacket(20), late = talk.makePacket(19);
  Conversation::addObject(back, 0, Vec3(1.1, 0, 0));
  Conversation::addObject(late, 1, Vec3(2.1, 0, 0));
  talk.arrive(back, 0.3);
  talk.arrive(late, 0.3);
  EXPECT_TRUE(talk.peer.isRenewed(talk.peer.ties[0], talk.rig.bodies.objects[0]));
  EXPECT_FALSE(talk.peer.isRenewed(talk.peer.ties[1], talk.rig.bodies.objects[1]));
  // The target starts at our copy, so that the spring is not stretched.
  EXPECT_LT((talk.target(0).p_W - Vec3(1.0, 0, 0)).norm(), 1e-15);

  // 8 ms later half a second of ramp gives 1.6 %.
  for (int tick = 300; tick <= 308; ++tick) talk.follow(tick * kPeriod);
  EXPECT_NEAR(talk.share(0), 0.008 / 0.5, 1e-12);
  EXPECT_EQ(talk.share(1), 0.0);
  EXPECT_NEAR(talk.target(0).p_W.x(), 1.0 + 0.25 * 9 * kPeriod, 1e-12);

  StatePacket renewed = talk.makePacket(21);
  Conversation::addObject(renewed, 1, Vec3(2.1, 0, 0));
  talk.arrive(renewed, 0.3085);
  talk.follow(0.309);
  EXPECT_GT(talk.share(1), 0.0);
  EXPECT_EQ(talk.share(1), talk.share(0));
}

// A reset of the peer's world, or a lie: the target moves there smoothly instead of jumping.
TEST(Peers, SmoothAStateThatJumped) {
  Conversation talk;
  const auto arrive = [&](std::uint64_t sequence, double x) {
    const double time = 0.008 * static_cast<double>(sequence);
    StatePacket packet = talk.makePacket(sequence);
    packet.time = time;
    packet.user.p_W = Vec3(x, 1, 0);
    Conversation::addObject(packet, 0, Vec3(1.0 + x, 0, 0), Vec3(1e6, 0, 0));
    talk.arrive(packet, time);
  };
  arrive(0, 0.0);
  arrive(1, 500.0);
  EXPECT_EQ(talk.rig.log.counters.peer_jumps, 2u);
  double x = talk.target(0).p_W.x();
  EXPECT_LT(x, 1.5);
  for (int tick = 9; tick < 2000; ++tick) {
    if (tick % 8 == 0) arrive(static_cast<std::uint64_t>(tick / 8), 500.0);
    talk.follow(tick * kPeriod);
    const RigidState& target = talk.target(0);
    ASSERT_LE(target.p_W.x() - x, 2.0 * kMostLeadSpeed * kPeriod);
    ASSERT_LE(target.v_W.norm(), 2.0 * kMostLeadSpeed + 1e-9);
    x = target.p_W.x();
  }
  EXPECT_EQ(talk.rig.log.counters.peer_jumps, 2u);
  EXPECT_GT(x, 10.0);
}

TEST(Peers, TakeWhatAPeerGrantsOnce) {
  Conversation talk;
  EnergyPort& energy = talk.rig.hand.energy();
  const double start = energy.observer().available();
  EXPECT_TRUE(talk.rig.peers.keepAccounts());
  const auto arrive = [&](std::uint64_t sequence, double granted) {
    StatePacket packet = talk.makePacket(sequence);
    packet.energy = {granted, 0.0};
    talk.arrive(packet, 0.01 * static_cast<double>(sequence));
    energy.receive(1.0, true);
  };
  arrive(0, 5.0);  // the first only says where the sum stands
  arrive(2, 5.75);
  arrive(1, 5.5);  // overtaken
  arrive(3, 5.75);
  EXPECT_NEAR(energy.observer().available() - start, 0.75, 1e-15);
  // A silence loses nothing: sums of grants go on.
  talk.follow(0.4);
  arrive(40, 6.0);
  EXPECT_NEAR(energy.observer().available() - start, 1.0, 1e-15);
  arrive(41, 0.25);  // a peer that began anew
  arrive(42, 0.5);
  EXPECT_NEAR(energy.observer().available() - start, 1.25, 1e-15);
  talk.arrive(talk.makePacket(43), 0.43);
  EXPECT_FALSE(talk.rig.peers.keepAccounts());
}

// Each packet tells one of 256 objects in turn, and two packets with the last one get lost.
TEST(Peers, KeepHoldOfWhatIsToldRarely) {
  constexpr std::uint64_t kObjects = 256;
  Conversation talk(kObjects);
  for (std::uint64_t n = 0; n < 4 * kObjects - 1; ++n) {
    StatePacket packet = talk.makePacket(n);
    const auto id = static_cast<ObjectId>(n % kObjects);
    if (id != kObjects - 1 || n < kObjects)
      Conversation::addObject(packet, id, Vec3(id + 1.0, 0, 0));
    talk.arrive(packet, static_cast<double>(n) / 16.0);
  }
  EXPECT_EQ(talk.share(kObjects - 1), 1.0);
}

// An object that is told no more has no force after four rounds of one object a packet.
TEST(Peers, LetGoOfWhatIsToldNoMoreAmongMany) {
  constexpr int kObjects = 20;
  Conversation talk(kObjects);
  const auto tell = [&](std::uint64_t from, std::uint64_t until, bool tells_last) {
    for (std::uint64_t n = from; n < until; ++n) {
      StatePacket packet = talk.makePacket(n);
      const auto id = static_cast<ObjectId>(n % kObjects);
      if (tells_last || id != kObjects - 1)
        Conversation::addObject(packet, id, Vec3(id + 1.0, 0, 0));
      talk.arrive(packet, static_cast<double>(n) / 128.0);
    }
  };
  tell(0, 20, true);
  tell(20, 20 + 70, false);
  EXPECT_EQ(talk.share(kObjects - 1), 1.0);
  tell(90, 20 + 90, false);
  EXPECT_EQ(talk.share(kObjects - 1), 0.0);
  EXPECT_EQ(talk.share(0), 1.0);
}

}  // namespace
}  // namespace tandem
