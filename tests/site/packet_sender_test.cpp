// Private header of the plugin: moments and contents of a site's packets.
#include "plugin/src/site/packet_sender.h"

#include <set>

#include <gtest/gtest.h>

#include "site/parts_rig.h"

namespace tandem {
namespace {

using test::kPeriod;

constexpr double kRate = 128.0;  // packets [Hz]
constexpr double kStart = 2.0;   // first tick [s]

struct SendingSite {
  explicit SendingSite(int objects) : rig(objects), link(10000) {
    rig.connect(link);
    rig.timeline.begin(kStart, 0.0);
  }

  /// Ticks that stop at the moments of packets, if `is_exact`.
  void run(int ticks, bool is_exact = true) {
    for (int i = 0; i < ticks; ++i, ++tick) {
      const double now = kStart + tick * kPeriod, end = kStart + (tick + 1) * kPeriod;
      rig.timeline.startTick(now);
      rig.sender.lookForIdleness(now);
      while (is_exact && rig.sender.due() < end - kSameTime) {
        rig.timeline.moveTo(rig.sender.due());
        rig.sender.sendIfDue(rig.sender.due(), true);
      }
      if (!is_exact) rig.sender.sendIfDue(now, false);
      rig.timeline.moveTo(end);
      rig.timeline.endTick();
    }
  }
  /// Uncouples the objects: they move freely.
  void letObjectsGo() {
    for (Tie& tie : rig.peers[0].ties) rig.island.setCouplerShare(tie.coupler, 0.0);
  }

  test::PartsRig rig;
  test::FakeLink link;
  int tick = 0;
};

TEST(PacketSender, SendsTheStateOfExactlyEachMoment) {
  SendingSite site(1);
  site.letObjectsGo();
  const double x = site.rig.island.state(site.rig.index(0)).p_W.x();
  site.rig.setVelocity(0, Vec3(0.25, 0, 0));
  site.run(1000);
  ASSERT_EQ(site.link.sent.size(), 128u);
  for (std::size_t n = 0; n < site.link.sent.size(); ++n) {
    const StatePacket& packet = site.link.sent[n];
    const double moment = static_cast<double>(n) / kRate;
    ASSERT_EQ(packet.sequence, n);
    ASSERT_NEAR(packet.time, kStart + moment, 1e-12);
    ASSERT_EQ(packet.object_count, 1u);
    ASSERT_NEAR(packet.objects[0].state.p_W.x(), x + 0.25 * moment, 1e-12) << n;
  }
  EXPECT_EQ(site.rig.log.counters.packets_sent, 128u);
}

TEST(PacketSender, SendsAtTheTickAfterEachMomentIfTheIslandIsNotThere) {
  SendingSite site(1);
  site.letObjectsGo();
  site.rig.setVelocity(0, Vec3(0.25, 0, 0));
  site.run(1000, false);
  ASSERT_EQ(site.link.sent.size(), 128u);
  for (std::size_t n = 0; n < site.link.sent.size(); ++n) {
    const double late = site.link.sent[n].time - (kStart + static_cast<double>(n) / kRate);
    ASSERT_GE(late, -1e-10) << n;
    ASSERT_LT(late, kPeriod) << n;
  }
}

TEST(PacketSender, SendsNothingForLostTime) {
  SendingSite site(0);
  site.run(10);
  const std::size_t before = site.link.sent.size();
  site.rig.sender.skipTo(kStart + 1.001);
  EXPECT_NEAR(site.rig.sender.due(), kStart + 129.0 / kRate, 1e-12);
  EXPECT_EQ(site.link.sent.size(), before);
  site.rig.sender.skipTo(kStart);
  EXPECT_NEAR(site.rig.sender.due(), kStart + 129.0 / kRate, 1e-12);
}

TEST(PacketSender, IsRareWhenIdleAndSendsTheFirstMotionAtOnce) {
  SendingSite site(1);
  site.run(2000);
  ASSERT_TRUE(site.rig.island.isAsleep());
  std::size_t first = 0;
  while (first < site.link.sent.size() && !site.link.sent[first].is_idle) ++first;
  ASSERT_LT(first + 20, site.link.sent.size());
  // Idle after half a second, told at the next packet.
  EXPECT_GE(site.link.sent[first].time, kStart + 0.5);
  EXPECT_LT(site.link.sent[first].time, kStart + 0.5 + 2.0 / kRate);
  const auto gap = [&](std::size_t n) {
    return site.link.sent[first + n].time - site.link.sent[first + n - 1].time;
  };
  // Five packets at the full rate, then one in eight.
  for (std::size_t n = 1; n < 5; ++n) EXPECT_NEAR(gap(n), 1.0 / kRate, 1e-12) << n;
  EXPECT_LE(gap(5), kIdlePacketPeriod + 1e-12);
  for (std::size_t n = 6; n < 20; ++n) EXPECT_NEAR(gap(n), kIdlePacketPeriod, 1e-12) << n;

  const std::size_t before = site.link.sent.size();
  site.rig.setVelocity(0, Vec3(0.1, 0, 0));
  site.run(1);
  ASSERT_GT(site.link.sent.size(), before);
  const StatePacket& motion = site.link.sent[before];
  EXPECT_FALSE(motion.is_idle);
  EXPECT_NEAR(motion.time, kStart + 2.0, 1e-12);
  EXPECT_EQ(motion.objects[0].state.v_W, Vec3(0.1, 0, 0));
}

TEST(PacketSender, IsNeverRareUnlessAsked) {
  SiteSettings settings;
  settings.thins_when_idle = false;
  test::PartsRig rig(0, settings);
  rig.timeline.endTick();
  for (int i = 0; i < 2000; ++i) {
    rig.sender.lookForIdleness(i * kPeriod);
    rig.sender.sendIfDue(i * kPeriod, false);
  }
  EXPECT_EQ(rig.log.counters.packets_sent, 256u);
}

/// Sends 20 objects, of which the first `moving` move. Checks the most packets in a row that leave
/// out a moving object, once all were sent, and any object.
void checkTurns(int moving, int most_moving, int most) {
  SCOPED_TRACE(moving);
  constexpr int kObjects = 20;
  constexpr std::size_t kTold = 40;  // packets, after which all have been told that others rest
  SendingSite site(kObjects);
  site.letObjectsGo();
  for (int i = 0; i < moving; ++i) site.rig.setVelocity(i, Vec3(0, 0, 0.01));
  site.run(1000);
  std::vector<int> silent(kObjects, 0);  // packets since each object was sent
  for (std::size_t n = 0; n < site.link.sent.size(); ++n) {
    const StatePacket& packet = site.link.sent[n];
    ASSERT_EQ(packet.object_count, static_cast<std::uint32_t>(kMaxObjectsPerPacket));
    std::set<ObjectId> ids;
    for (std::uint32_t i = 0; i < packet.object_count; ++i) ids.insert(packet.objects[i].id);
    ASSERT_EQ(ids.size(), packet.object_count);
    for (int i = 0; i < kObjects; ++i) {
      int& since = silent[static_cast<std::size_t>(i)];
      since = ids.contains(static_cast<ObjectId>(i)) ? 0 : since + 1;
      ASSERT_LE(since, n >= kTold && i < moving ? most_moving : most)
          << "packet " << n << ", object " << i;
    }
  }
}

TEST(PacketSender, CarriesAtMostEightObjectsAndForgetsNone) {
  // All 3 that move go into each packet; 5 places are left for 17 others.
  checkTurns(3, 0, 5);
  // With 12 that move, 7 go into each packet, and one place goes round all 20.
  checkTurns(12, 1, 20);
}

// A body that is thrown out of the range of packets must not silence the others.
TEST(PacketSender, WithholdsOnlyWhatIsOutOfRangeAndSaysSo) {
  SendingSite site(3);
  site.letObjectsGo();
  RigidState far = site.rig.island.state(site.rig.index(1));
  far.p_W.x() = 1001.0;  // beyond +-1000 m
  site.rig.island.setState(site.rig.index(1), far);
  RigidState fast = site.rig.island.state(site.rig.index(2));
  fast.v_W.y() = 101.0;  // beyond +-100 m/s
  site.rig.island.setState(site.rig.index(2), fast);
  site.run(20);
  ASSERT_FALSE(site.link.sent.empty());
  for (const StatePacket& packet : site.link.sent) {
    ASSERT_EQ(packet.object_count, 1u);
    EXPECT_EQ(packet.objects[0].id, 0u);
  }
  EXPECT_EQ(site.rig.log.endTick() & kOutOfRange, kOutOfRange);
  EXPECT_EQ(site.rig.log.counters.states_withheld, 2 * site.link.sent.size());
  EXPECT_FALSE(site.rig.log.hasFault());
}

}  // namespace
}  // namespace tandem
