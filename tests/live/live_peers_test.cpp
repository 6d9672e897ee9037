// Two live sites of this process over real sockets. No test asserts times; each waits as long as a
// loaded machine may need.

#include "tandem/plugin/live_peers.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tandem/falcon/monotonic_clock.h"

#include "net/virtual_net.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::makePacket;

constexpr double kPatience = 30.0;  // [s]
constexpr double kTick = 1e-3;      // [s]
constexpr PeerId kOne{1}, kTwo{2};
const PointState kHeld{{0.1, 0.2, 0.3}, Vec3::Zero()};

std::unique_ptr<LivePeers> makePeers(PeerId self, PeerId other, std::optional<Address> address) {
  UdpMeshSettings settings;
  settings.self = self;
  settings.bind = resolveAddress("127.0.0.1:0");
  settings.configuration = makeConfiguration({{"object.mass", "0.2"}});
  std::vector<UdpPeer> peers;
  peers.push_back({other, address, test::makeKey(7)});
  return std::make_unique<LivePeers>(settings, std::move(peers));
}

/// Site 1 knows the address of site 2, which waits for the call.
struct Two {
  std::unique_ptr<LivePeers> two = makePeers(kTwo, kOne, std::nullopt);
  std::unique_ptr<LivePeers> one = makePeers(kOne, kTwo, two->bound());

  [[nodiscard]] bool areBoth(PeerPhase phase) const {
    const double now = readMonotonicClock();
    return one->status(kTwo, now).phase == phase && two->status(kOne, now).phase == phase;
  }
  void poll() const {
    one->poll(readMonotonicClock());
    two->poll(readMonotonicClock());
    one->wait(1e-3);
  }
};

template <typename Done>
[[nodiscard]] bool waitUntil(Done done) {
  for (const double end = readMonotonicClock() + kPatience; readMonotonicClock() < end;) {
    if (done()) return true;
    sleepFor(1e-3);
  }
  return done();
}

TEST(LivePeers, PolledByTheirHostCarryStates) {
  const Two two;
  ASSERT_TRUE(waitUntil([&] { return two.poll(), two.areBoth(PeerPhase::kLive); }));
  double time = 3.0;  // site time; the host steps at any time [s]
  std::optional<Arrival> arrival;
  EXPECT_TRUE(waitUntil([&] {
    time += 0.016;
    two.one->poll(readMonotonicClock(), time);
    two.two->poll(readMonotonicClock(), time);
    StatePacket packet = makePacket(kOne, 0, Vec3(0.25, 0, 0));
    packet.time = time;
    two.one->link(kTwo).send(packet, time);
    arrival = two.two->link(kOne).receive(time, time + 0.016);
    return arrival.has_value();
  }));
  EXPECT_EQ(arrival->packet.sender, kOne);
  EXPECT_EQ(arrival->packet.user.p_W.x(), 0.25);
  EXPECT_GE(arrival->time, time);
  EXPECT_LE(arrival->packet.time, time) << "without an agreed start its time is as it was sent";
}

TEST(LivePeers, WithThreadsAgreeOnAStartAndCarryStates) {
  const Two two;
  for (const auto& peers : {two.one.get(), two.two.get()}) {
    peers->agreeOnStart(kHeld, 128.0);
    peers->startThread();
  }
  ASSERT_TRUE(waitUntil([&] { return two.one->start() && two.two->start(); }));
  // Both use one clock here. A loaded machine delays one direction and not the other.
  EXPECT_NEAR(*two.one->start(), *two.two->start(), 0.5);

  // This thread is the haptic thread of both.
  std::optional<Arrival> at_one, at_two;
  EXPECT_TRUE(waitUntil([&] {
    const double now = readMonotonicClock();
    const auto tick = [&](LivePeers& peers, PeerId self, PeerId other,
                          std::optional<Arrival>& got) {
      const double time = now - *peers.start();
      if (time < 0.0) return;
      StatePacket packet = makePacket(self, 0, Vec3::Zero());
      packet.time = time;
      peers.link(other).send(packet, time);
      if (const auto arrival = peers.link(other).receive(time, time + kTick)) got = arrival;
    };
    tick(*two.one, kOne, kTwo, at_one);
    tick(*two.two, kTwo, kOne, at_two);
    return at_one && at_two;
  }));
  EXPECT_GE(at_two->packet.time, 0.0) << "the countdown is not for the site";
  EXPECT_LT(at_two->packet.time, kPatience) << "it is the peer's own time";
  EXPECT_EQ(two.one->lost(), 0u);

  two.one->sayFarewell();
  EXPECT_TRUE(waitUntil(
      [&] { return two.two->status(kOne, readMonotonicClock()).phase == PeerPhase::kLeft; }));
}

TEST(LivePeers, AThreadStopsAndStartsAgain) {
  const Two two;
  for (int i = 0; i < 3; ++i) {
    two.one->startThread();
    EXPECT_THROW(two.one->startThread(), std::invalid_argument);
    two.one->stopThread();
    two.one->stopThread();
  }
  EXPECT_TRUE(waitUntil([&] { return two.poll(), two.areBoth(PeerPhase::kLive); }));
}

TEST(LivePeers, ASiteThatJoinsLateSetsItsStart) {
  const Two two;
  EXPECT_FALSE(two.one->start());
  two.one->setStart(123.0);
  EXPECT_EQ(two.one->start(), 123.0);
  two.one->agreeOnStart(kHeld, 128.0);
  EXPECT_FALSE(two.one->start());
  two.one->setStart(124.0);
  two.poll();
  EXPECT_EQ(two.one->start(), 124.0);
}

TEST(LivePeers, RefuseWhatIsOutOfRange) {
  const Two two;
  EXPECT_THROW((void)two.one->link(PeerId{3}), std::invalid_argument);
  EXPECT_THROW(two.one->setHapticThread(PeerId{3}, true), std::invalid_argument);
  EXPECT_THROW(two.one->startThread(100), std::invalid_argument);
  EXPECT_THROW(two.one->startThread(-1), std::invalid_argument);
  EXPECT_THROW(two.one->agreeOnStart(kHeld, 0.0), std::invalid_argument);
  EXPECT_THROW(two.one->agreeOnStart(kHeld, 128.0, 0.0), std::invalid_argument);
  EXPECT_THROW(two.one->setStart(std::numeric_limits<double>::infinity()), std::invalid_argument);
}

}  // namespace
}  // namespace tandem
