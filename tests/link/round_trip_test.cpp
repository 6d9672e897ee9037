#include "coordination/src/link/round_trip.h"

#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

#include "support/random.h"

namespace tandem {
namespace {

constexpr double kPeriod = 1.0 / 128.0;

/// Sends one datagram and its answer with these delays, to a peer whose clock is ahead.
void exchange(RoundTrip& trip, double start, double there, double hold, double back, double ahead) {
  trip.add(start, start + there + hold + ahead, hold, start + there + hold + back);
}

TEST(RoundTrip, EqualWaysGiveTheOffset) {
  RoundTrip trip;
  EXPECT_FALSE(trip.isKnown());
  exchange(trip, 10.0, 0.05, 0.003, 0.05, 42.0);
  EXPECT_TRUE(trip.isKnown());
  EXPECT_NEAR(trip.trip(), 0.1, 1e-12);
  EXPECT_NEAR(trip.fastest(), 0.1, 1e-12);
  EXPECT_NEAR(trip.offset(), 42.0, 1e-12);
}

TEST(RoundTrip, ErrorIsHalfTheDifferenceOfTheWays) {
  RoundTrip trip;
  for (int i = 0; i < 100; ++i) exchange(trip, i * kPeriod, 0.02, 0.001, 0.18, -7.0);
  EXPECT_NEAR(trip.trip(), 0.2, 1e-12);
  EXPECT_NEAR(trip.offset(), -7.0 - 0.08, 1e-12);
}

TEST(RoundTrip, FastestTripsKnowTheOffset) {
  constexpr std::uint64_t kSeed = 20090402;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  RoundTrip trip;
  for (int i = 0; i < 4000; ++i) {
    const double jitter = random.uniform(0.0, 1.0);
    exchange(trip, i * kPeriod, 0.05 + 0.02 * jitter * jitter, 0.004,
             0.05 + 0.02 * random.uniform(0.0, 1.0), 3.0);
  }
  EXPECT_NEAR(trip.offset(), 3.0, 5e-4);
}

TEST(RoundTrip, FollowsAWayThatBecameLonger) {
  RoundTrip trip;
  for (int i = 0; i < 500; ++i) exchange(trip, i * kPeriod, 0.05, 0.0, 0.05, 0.0);
  for (int i = 500; i < 3000; ++i) exchange(trip, i * kPeriod, 0.1, 0.0, 0.1, 0.0);
  EXPECT_NEAR(trip.fastest(), 0.2, 1e-9);
  EXPECT_NEAR(trip.trip(), 0.2, 1e-6);
}

TEST(RoundTrip, NonsenseIsLeftOut) {
  RoundTrip trip;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  trip.add(2.0, 0.0, 0.0, 1.0);   // returned before it was sent
  trip.add(0.0, 0.0, 5.0, 1.0);   // held for longer than the whole trip
  trip.add(0.0, 0.0, -1.0, 1.0);  // held for a negative time
  trip.add(kNan, 0.0, 0.0, 1.0);
  trip.add(0.0, kNan, 0.0, 1.0);
  EXPECT_FALSE(trip.isKnown());
}

}  // namespace
}  // namespace tandem
