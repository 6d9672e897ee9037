// One site as a spectator sees it, told 32 times a second over a bad network.

#include "watch/watched_track.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "view/watched_states.h"

namespace tandem::view {
namespace {

using tandem::test::WatchedStates;

constexpr double kPeriod = 1.0 / 32.0;  // [s]
constexpr double kDelay = 0.02;         // shortest way of a state [s]
constexpr double kClock = 990.0;        // of the site, before the spectator's [s]

/// 50 mm to and fro at 1 Hz.
PointState swing(double time) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  PointState hand;
  hand.p_W.x() = 0.05 * std::sin(kTurn * time);
  hand.v_W.x() = 0.05 * kTurn * std::cos(kTurn * time);
  return hand;
}

// 15 ms of jitter and 5 % loss. A hand that stays until the next state comes is up to 15 mm away;
// after two lost states this one goes on at its speed for 46 ms.
TEST(WatchedTrack, AHandMovesEvenlyOverABadNetwork) {
  std::mt19937_64 random(7);
  const auto draw = [&] { return static_cast<double>(random()) / 18446744073709551616.0; };
  WatchedStates states;
  WatchedTrack track;
  double farthest = 0.0, last_heard = 0.0;
  int next = 0, lost = 0;
  double due = kDelay;
  for (double now = 0.0; now < 20.0; now += 1.0 / 60.0) {
    for (; due <= now; ++next, due = next * kPeriod + kDelay + 0.015 * draw()) {
      const double time = next * kPeriod;
      if (draw() < 0.05 && ++lost > 0) continue;
      last_heard = std::max(last_heard, due);
      track.take(states.next(kClock + time, last_heard, swing(time)));
    }
    if (now < 1.0) continue;
    const Vec3 shown_W = track.hand(now);
    // The clock's estimate may lag by the jitter's part that never came.
    double best = HUGE_VAL;
    for (double lag = 0.0; lag < 0.004; lag += 1e-4)
      best = std::min(best, (shown_W - swing(now - kDelay - WatchedTrack::kLate - lag).p_W).norm());
    farthest = std::max(farthest, best);
  }
  EXPECT_GT(lost, 10);
  EXPECT_LT(farthest, 1e-3);
}

TEST(WatchedTrack, IsSilentAfterHalfASecondAndComesBack) {
  WatchedStates states;
  WatchedTrack track;
  track.take(states.next(kClock, 1.0, swing(0.0)));
  EXPECT_TRUE(track.isLive(1.4));
  EXPECT_FALSE(track.isLive(1.6));
  EXPECT_NEAR(track.age(1.6), 0.6, 1e-12);
  track.take(states.next(kClock + 1.0, 2.0, swing(0.25)));
  EXPECT_TRUE(track.isLive(2.0));
}

// Another run of the site counts from elsewhere. Hand and object glide to where they are now.
TEST(WatchedTrack, FollowsASiteThatBeginsAnew) {
  WatchedStates states;
  WatchedTrack track;
  const PointState there{{0.1, 0.0, 0.0}, Vec3::Zero()};
  for (int i = 0; i < 8; ++i)
    track.take(states.next(kClock + 5.0 + i * kPeriod, 6.0 + i * kPeriod, swing(0.0)));
  for (int i = 0; i < 6; ++i)
    track.take(states.next(kClock + i * kPeriod, 6.3 + i * kPeriod, there, Vec3::UnitY()));
  EXPECT_NEAR(track.hand(6.3 + 8 * kPeriod).x(), 0.1, 1e-12);
  EXPECT_NEAR(track.object(0, 6.3 + 8 * kPeriod)->p_W.y(), 1.0, 1e-12);
  EXPECT_NEAR(track.hand(6.3).x(), 0.05, 1e-12);
  EXPECT_FALSE(track.object(1, 6.3));
}

}  // namespace
}  // namespace tandem::view
