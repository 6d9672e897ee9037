#include "live/site_clock.h"

#include <gtest/gtest.h>

#include "support/random.h"

namespace tandem {
namespace {

TEST(SiteClock, TakesTheFirstReadings) {
  SiteClock times;
  EXPECT_FALSE(times.isKnown());
  times.note(1000.0, 3.0);
  EXPECT_TRUE(times.isKnown());
  EXPECT_FALSE(times.isSet());
  EXPECT_EQ(times.toClock(3.5), 1000.5);
  EXPECT_EQ(times.toSite(1000.5), 3.5);
}

// A host that steps at 60 Hz shows its time up to a step late.
TEST(SiteClock, EvensOutReadingsThatJitter) {
  constexpr double kStep = 1.0 / 60.0;  // [s]
  test::Random random(7);
  SiteClock times;
  times.note(500.0, 0.0);
  for (int i = 1; i <= 600; ++i) {
    const double late = random.uniform(0.0, kStep);
    times.note(500.0 + kStep * i + late, kStep * i);
  }
  // The delay is half a step on average. The estimate remembers 20 readings, so its deviation is a
  // sixth of one reading's.
  EXPECT_NEAR(times.toClock(0.0), 500.0 + 0.5 * kStep, 0.2 * kStep);
}

TEST(SiteClock, TakesAJumpAtOnce) {
  SiteClock times;
  for (int i = 0; i < 10; ++i) times.note(10.0 + 0.01 * i, 0.01 * i);
  times.note(25.0, 5.0);
  EXPECT_EQ(times.toClock(5.0), 25.0);
}

TEST(SiteClock, KeepsWhatIsSet) {
  SiteClock times;
  times.note(10.0, 1.0);
  times.set(100.0);
  times.note(10.0, 1.0);
  EXPECT_TRUE(times.isSet());
  EXPECT_EQ(times.toClock(1.0), 101.0);
  times.waitUntilSet();
  times.note(10.0, 1.0);
  EXPECT_FALSE(times.isKnown());
}

}  // namespace
}  // namespace tandem
