// Private header of the plugin: a peer that restarted, or packets that are late.
#include "plugin/src/site/restart_watch.h"

#include <gtest/gtest.h>

#include "support/fakes.h"

namespace tandem {
namespace {

/// The newest packet has sequence 1000 and the peer's time 8 s; it came at 8.05 s.
struct Watched {
  RestartWatch watch;
  StatePacket newest = at(1000, 8.0);

  static StatePacket at(std::uint64_t sequence, double time) {
    StatePacket packet = test::makePacket(PeerId{2}, sequence, Vec3::Zero());
    packet.time = time;
    return packet;
  }
  bool isRestart(std::uint64_t sequence, double time, double arrived) {
    return watch.isRestart(at(sequence, time), newest, arrived);
  }
};

TEST(RestartWatch, TakesThreePacketsOfALaterTimeForOne) {
  Watched peer;
  EXPECT_FALSE(peer.isRestart(0, 10.0, 10.0));
  EXPECT_FALSE(peer.isRestart(1, 10.1, 10.1));
  EXPECT_TRUE(peer.isRestart(2, 10.2, 10.2));
}

TEST(RestartWatch, TakesPacketsOfANewClockForOneAfterTwoSeconds) {
  Watched peer;
  for (std::uint64_t n = 0; n <= 20; ++n) {
    const double time = 0.1 * static_cast<double>(n);
    EXPECT_FALSE(peer.isRestart(n, time, 10.0 + time)) << n;
  }
  EXPECT_TRUE(peer.isRestart(21, 2.1, 12.1));
}

// A full buffer lets 1.9 s of old packets through, at once or at their pace.
TEST(RestartWatch, TakesLatePacketsForNone) {
  for (const double pace : {0.0, 1.0, 2.0}) {
    Watched peer;
    for (std::uint64_t n = 0; n < 243; ++n) {
      const double sent = 6.0 + static_cast<double>(n) / 128.0;
      EXPECT_FALSE(peer.isRestart(757 + n, sent, 9.0 + pace * (sent - 6.0))) << n;
    }
  }
}

TEST(RestartWatch, TakesOvertakenAndDoubledPacketsForNone) {
  Watched peer;
  for (int i = 0; i < 100; ++i) {
    for (const std::uint64_t n : {990u, 992u, 991u, 990u}) {
      const double sent = 8.0 - static_cast<double>(1000 - n) / 128.0;
      EXPECT_FALSE(peer.isRestart(n, sent, 8.1 + 0.1 * i));
    }
    if (i % 2 == 0) peer.watch.noteNewest();
  }
}

}  // namespace
}  // namespace tandem
