// Private header of the plugin: what each of many peers is told, and how often.
#include "plugin/src/site/interest.h"

#include <algorithm>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "site/parts_rig.h"

namespace tandem {
namespace {

using test::kPeriod;

constexpr double kRate = 128.0;    // packets [Hz]
constexpr double kBudget = 400e3;  // [bit/s]; two peers would get 1.4 Mbit/s
constexpr double kFar = 50.0;      // [m]

SiteSettings withBudget(double budget) {
  SiteSettings settings;
  settings.packet_budget = budget;
  settings.thins_when_idle = false;
  return settings;
}

/// One site among peers whose hands are where the test says. Objects stand along x, a metre apart;
/// the local hand is at the origin.
struct Crowd {
  Crowd(int objects, int peers, double budget) : rig(objects, withBudget(budget)) {
    for (int i = 0; i < peers; ++i) {
      links.push_back(std::make_unique<test::FakeLink>(100'000));
      rig.connect(*links.back(), PeerId{static_cast<std::uint32_t>(i) + 2});
      for (Tie& tie : rig.peers[i].ties) rig.island.setCouplerShare(tie.coupler, 0.0);
      hands.push_back({Vec3(0, kFar + i, 0), Vec3::Zero()});
    }
    rig.timeline.begin(0.0, 0.0);
  }

  /// Runs ticks; each peer is heard every eighth.
  void run(int count) {
    for (int i = 0; i < count; ++i, ++ticks) {
      for (std::size_t k = 0; ticks % 8 == 0 && k < hands.size(); ++k) hear(k);
      rig.peers.takeInUntil(now(), now());
      rig.timeline.startTick(now());
      while (rig.sender.due() < now() + kPeriod - kSameTime) {
        rig.timeline.moveTo(rig.sender.due());
        rig.sender.sendIfDue(rig.sender.due(), true);
      }
      rig.timeline.moveTo(now() + kPeriod);
      rig.timeline.endTick();
    }
  }
  void hear(std::size_t peer) {
    hands[peer].p_W += 8 * kPeriod * hands[peer].v_W;
    StatePacket packet = test::makePacket(PeerId{static_cast<std::uint32_t>(peer) + 2},
                                          static_cast<std::uint64_t>(ticks), hands[peer].p_W);
    packet.user.v_W = hands[peer].v_W;
    packet.time = now();
    links[peer]->arrivals.push_back({packet, now()});
  }
  void forget() {
    for (auto& link : links) link->sent.clear();
  }
  /// Runs ticks after the first second, of which nothing is kept.
  void runSettled(int count) {
    run(1000);
    forget();
    run(count);
  }
  [[nodiscard]] double now() const { return ticks * kPeriod; }
  [[nodiscard]] const std::vector<StatePacket>& sent(std::size_t peer) const {
    return links[peer]->sent;
  }
  /// Longest time between two packets that tell a peer of an object [s].
  [[nodiscard]] double computeWait(std::size_t peer, ObjectId id) const {
    double last = sent(peer).front().time, longest = 0.0;
    for (const StatePacket& packet : sent(peer)) {
      longest = std::max(longest, packet.time - last);
      const auto* end = packet.objects.data() + packet.object_count;
      if (std::any_of(packet.objects.data(), end,
                      [&](const ObjectState& object) { return object.id == id; }))
        last = packet.time;
    }
    return longest;
  }
  /// To all peers [bit].
  [[nodiscard]] double countBits() const {
    double bytes = 0.0;
    for (const auto& link : links)
      for (const StatePacket& packet : link->sent)
        bytes += computeDatagramBytes(packet.object_count, packet.grip.has_value());
    return 8.0 * bytes;
  }

  test::PartsRig rig;
  std::vector<std::unique_ptr<test::FakeLink>> links;
  std::vector<PointState> hands;  ///< of the peers
  int ticks = 0;
};

TEST(Interest, WithoutABudgetAllPeersGetAllPackets) {
  Crowd crowd(3, 4, 0.0);
  crowd.run(1000);
  for (std::size_t peer = 0; peer < 4; ++peer) {
    ASSERT_EQ(crowd.sent(peer).size(), 128u);
    for (const StatePacket& packet : crowd.sent(peer)) {
      EXPECT_FALSE(packet.is_idle);
      EXPECT_EQ(packet.object_count, 3u);
    }
  }
}

TEST(Interest, ABudgetThatSufficesChangesNothing) {
  Crowd crowd(8, 2, 2e6);
  crowd.run(1000);
  EXPECT_EQ(crowd.sent(0).size(), 128u);
  EXPECT_EQ(crowd.sent(1).size(), 128u);
}

TEST(Interest, FarPeersGetRarePacketsThatSaySo) {
  Crowd crowd(8, 2, kBudget);
  crowd.hands[0].p_W = Vec3(0, 0.1, 0);
  crowd.runSettled(1000);
  EXPECT_EQ(crowd.sent(0).size(), 128u);
  EXPECT_GE(crowd.sent(1).size(), 8u);
  EXPECT_LE(crowd.sent(1).size(), 17u);
  for (const StatePacket& packet : crowd.sent(0)) EXPECT_FALSE(packet.is_idle);
  for (const StatePacket& packet : crowd.sent(1)) EXPECT_TRUE(packet.is_idle);
}

// Far from both hands, user 2 reaches the object that the local user's hand is at.
TEST(Interest, ReachingTheSameObjectMakesPeersNear) {
  Crowd crowd(8, 2, kBudget);
  crowd.rig.bodies.objects[0].tool_of = PeerId{1};
  crowd.hands[1].p_W = Vec3(1, 0.02, 0);
  crowd.runSettled(1000);
  EXPECT_LE(crowd.sent(0).size(), 17u);
  EXPECT_EQ(crowd.sent(1).size(), 128u);
}

// Five packets at the full rate say that they get rare, so a lost one does no harm.
TEST(Interest, APeerThatGoesAwayIsToldSoFiveTimes) {
  Crowd crowd(8, 2, kBudget);
  crowd.hands[0] = {Vec3(0, 0.1, 0), Vec3(0, 1, 0)};
  crowd.run(2000);
  const auto& sent = crowd.sent(0);
  std::size_t first = 0;  // that says so, after those that do not
  for (std::size_t n = 1; n < sent.size(); ++n)
    if (sent[n].is_idle && !sent[n - 1].is_idle) first = n;
  ASSERT_GT(first, 10u);
  for (std::size_t n = first; n < first + 5; ++n)
    EXPECT_NEAR(sent[n].time - sent[n - 1].time, 1.0 / kRate, 1e-9) << n;
  EXPECT_GT(sent[first + 7].time - sent[first + 6].time, 7.9 / kRate);
}

TEST(Interest, FullRateBeginsBeforeTheHandArrives) {
  Crowd crowd(8, 2, kBudget);
  crowd.hands[0] = {Vec3(0, 2.0, 0), Vec3(0, -1, 0)};
  crowd.run(2000);
  const auto& sent = crowd.sent(0);
  const auto first = std::find_if(sent.begin(), sent.end(),
                                  [](const StatePacket& packet) { return !packet.is_idle; });
  ASSERT_NE(first, sent.end());
  const double distance = 2.0 - first->time;  // at 1 m/s
  EXPECT_GT(distance, 0.35);
  EXPECT_LT(distance, 0.6);
}

TEST(Interest, AnObjectIsToldAtOnceWhenItBeginsToMove) {
  Crowd crowd(256, 3, kBudget);
  crowd.run(3000);
  for (const int object : {40, 200}) {
    crowd.forget();
    const double before = crowd.now();
    crowd.rig.setVelocity(object, Vec3(0, 0, 0.1));
    crowd.run(20);
    for (std::size_t peer = 0; peer < 3; ++peer) {
      const auto& sent = crowd.sent(peer);
      const auto told = std::find_if(sent.begin(), sent.end(), [&](const StatePacket& packet) {
        const auto* end = packet.objects.data() + packet.object_count;
        return std::any_of(packet.objects.data(), end, [&](const ObjectState& state) {
          return state.id == static_cast<ObjectId>(object);
        });
      });
      ASSERT_NE(told, sent.end()) << object << ", peer " << peer;
      EXPECT_LT(told->time - before, 1.1 / kRate) << object << ", peer " << peer;
    }
  }
}

// Sixty objects move; the one at the local hand is in every packet.
TEST(Interest, WhatIsTouchedIsToldAtFullRateAmongManyThatMove) {
  Crowd crowd(100, 2, 0.0);
  crowd.rig.bodies.objects[50].tool_of = PeerId{1};
  for (int i = 20; i < 80; ++i) crowd.rig.setVelocity(i, Vec3(0, 0, 1e-3));
  crowd.runSettled(1000);
  for (std::size_t peer = 0; peer < 2; ++peer)
    EXPECT_NEAR(crowd.computeWait(peer, 50), 1.0 / kRate, 1e-9);
}

// 256 objects, 15 peers and 1 Mbit/s. One peer is near; all are told of what moves.
TEST(Interest, ARoomKeepsItsBudgetAndForgetsNothing) {
  constexpr double kRoom = 1e6, kSeconds = 20.0;
  Crowd crowd(256, 15, kRoom);
  crowd.hands[4].p_W = Vec3(0, 0.05, 0);
  for (const int moving : {3, 50, 51, 90, 140, 200, 255})
    crowd.rig.setVelocity(moving, Vec3(0, 0, 1e-3));
  crowd.runSettled(static_cast<int>(kSeconds / kPeriod));
  // The bytes of a rare packet's period may have been kept from before.
  EXPECT_LE(crowd.countBits(), kRoom * (kSeconds + kIdlePacketPeriod));
  EXPECT_GE(crowd.countBits(), 0.5 * kRoom * kSeconds);
  EXPECT_EQ(crowd.sent(4).size(), static_cast<std::size_t>(kRate * kSeconds));
  for (std::size_t peer = 0; peer < 15; ++peer) {
    for (const ObjectId moving : {3u, 50u, 51u, 90u, 140u, 200u, 255u})
      EXPECT_LE(crowd.computeWait(peer, moving), 1.0 / 8.0 + 1e-6) << peer << ": " << moving;
    const double packets = static_cast<double>(crowd.sent(peer).size()) / kSeconds;  // [Hz]
    for (ObjectId id = 0; id < 256; ++id)
      EXPECT_LE(crowd.computeWait(peer, id), 256.0 / packets + 0.2) << peer << ": " << id;
  }
}

}  // namespace
}  // namespace tandem
