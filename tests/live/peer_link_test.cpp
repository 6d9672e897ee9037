// Tests the conversion between a site's time and the clock of its connection alone; time is passed
// in.

#include "live/peer_link.h"

#include <gtest/gtest.h>

#include "live/shifted_link.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::FakeLink;
using test::makePacket;
using test::ShiftedLink;

constexpr PeerId kHere{1}, kThere{2};
constexpr double kTick = 1e-3;    // [s]
constexpr double kAhead = 2e-3;   // [s]
constexpr double kClock = 500.0;  ///< the clock at site time 0 [s]

/// A link to a peer, over a fake connection that uses the clock.
struct Rig {
  FakeLink wire{64};
  ShiftedLink way{wire, 0.0};
  PeerLink link{way};

  void arrive(double clock, double time = 0.0) {
    StatePacket packet = makePacket(kThere, arrived++, Vec3::Zero());
    packet.time = time;
    wire.arrivals.push_back({packet, clock});
  }
  void send(double time) { link.send(makePacket(kHere, 0, Vec3::Zero()), time); }
  std::uint64_t arrived = 0;
};

TEST(PeerLink, GivesNothingBeforeItWasPolled) {
  Rig rig;
  rig.arrive(0.0);
  EXPECT_FALSE(rig.link.receive(0.0, kTick));
}

TEST(PeerLink, GivesArrivalsInTheSitesTime) {
  Rig rig;
  rig.arrive(kClock + 0.0995);
  rig.arrive(kClock + 0.1005);
  rig.link.bridge().setClock(kClock + 0.1);
  const auto late = rig.link.receive(0.1, 0.1 + kTick);
  ASSERT_TRUE(late);
  EXPECT_EQ(late->time, 0.1) << "what was there before counts from the tick on";
  const auto inside = rig.link.receive(0.1, 0.1 + kTick);
  ASSERT_TRUE(inside);
  EXPECT_NEAR(inside->time, 0.1005, 1e-12);
  EXPECT_FALSE(rig.link.receive(0.1, 0.1 + kTick));
}

TEST(PeerLink, StampsStatesWithTheClock) {
  Rig rig;
  rig.link.bridge().setClock(kClock);
  rig.send(0.0);
  rig.send(0.008);
  EXPECT_EQ(rig.way.stamps, (std::vector<double>{kClock, kClock}));
  EXPECT_EQ(rig.wire.sent[0].time, 0.0);
}

// The ticks of a step of 16 ms run at once, and are stamped as if they took 16 ms.
TEST(PeerLink, StampsTheTicksOfAHostsStepAsInRealTime) {
  Rig rig;
  rig.link.bridge().setClock(kClock);
  rig.link.bridge().setSiteTime(2.0);
  rig.send(2.0);
  rig.send(2.008);
  EXPECT_EQ(rig.way.stamps, (std::vector<double>{kClock, kClock + 0.008}));
  // The next step comes late; the host defines the site's time.
  rig.link.bridge().setClock(kClock + 0.5);
  rig.link.bridge().setSiteTime(2.016);
  rig.arrive(kClock + 0.505);
  const auto arrival = rig.link.receive(2.016, 2.032);
  ASSERT_TRUE(arrival);
  EXPECT_NEAR(arrival->time, 2.021, 1e-12);
}

// A peer drops states whose number is not above the last one.
TEST(PeerLink, NumbersGoOnWhenASiteBeginsAnew) {
  Rig rig;
  rig.link.bridge().setClock(kClock);
  for (int site = 0; site < 2; ++site)
    for (std::uint64_t i = 0; i < 3; ++i)
      rig.link.send(makePacket(kHere, i, Vec3::Zero()), 1e-3 * static_cast<double>(i));
  for (std::uint64_t i = 0; i < 6; ++i) EXPECT_EQ(rig.wire.sent[i].sequence, i);
}

TEST(PeerLink, WaitsForTheFirstTickOfAHapticThread) {
  Rig rig;
  rig.link.setHapticThread(true);
  rig.arrive(kClock - 1.0);
  rig.link.bridge().setClock(kClock);
  rig.link.exchange(kAhead);
  EXPECT_FALSE(rig.link.receive(7.0, 7.0 + kTick)) << "the site's time was not known";
  rig.send(7.0);
  EXPECT_TRUE(rig.wire.sent.empty()) << "the haptic thread does not touch the connection";

  rig.link.bridge().setClock(kClock + 1e-4);
  rig.link.exchange(kAhead);
  EXPECT_EQ(rig.way.stamps, (std::vector<double>{kClock + 1e-4}));
  const auto arrival = rig.link.receive(7.001, 7.001 + kTick);
  ASSERT_TRUE(arrival);
  EXPECT_EQ(arrival->time, 7.001);
  EXPECT_EQ(rig.link.lost(), 0u);
}

TEST(PeerLink, BringsWhatIsDueToTheHapticThreadBeforehand) {
  Rig rig;
  rig.link.setHapticThread(true);
  rig.link.bridge().setStart(kClock);
  rig.arrive(kClock + 1.5e-3);
  rig.arrive(kClock + 5e-3);
  rig.link.bridge().setClock(kClock);
  rig.link.exchange(kAhead);
  EXPECT_EQ(rig.wire.arrivals.size(), 1u) << "the other is due later";
  EXPECT_FALSE(rig.link.receive(0.0, kTick));
  const auto arrival = rig.link.receive(kTick, 2 * kTick);
  ASSERT_TRUE(arrival);
  EXPECT_NEAR(arrival->time, 1.5e-3, 1e-12);
}

// States of the countdown serve the start only; later ones have the peer's own time.
TEST(PeerLink, KeepsStatesOfTheCountdownFromTheSite) {
  Rig rig;
  TimeBridge& bridge = rig.link.bridge();
  bridge.awaitStart();
  bridge.setClock(kClock);
  rig.arrive(kClock, TimeBridge::kBefore + 0.25);
  EXPECT_FALSE(rig.link.receive(0.0, 1.0)) << "there is no start yet";
  bridge.setStart(kClock);
  rig.wire.arrivals.clear();
  rig.arrive(kClock, 0.0);
  rig.arrive(kClock, TimeBridge::kBefore - 0.25);
  rig.arrive(kClock, TimeBridge::kBefore + 0.25);
  const auto arrival = rig.link.receive(0.0, 1.0);
  ASSERT_TRUE(arrival);
  EXPECT_EQ(arrival->packet.time, 0.25);
  EXPECT_FALSE(rig.link.receive(0.0, 1.0));
  rig.send(0.5);
  EXPECT_EQ(rig.wire.sent.back().time, 0.0 + TimeBridge::kBefore);
}

}  // namespace
}  // namespace tandem
