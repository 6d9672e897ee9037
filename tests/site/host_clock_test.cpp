// Private header of the plugin: the host's time at a site.
#include "plugin/src/site/host_clock.h"

#include <gtest/gtest.h>

namespace tandem {
namespace {

constexpr double kStep = 1.0 / 64.0;    // of the host [s]; exact in binary
constexpr double kTick = 1.0 / 1024.0;  // haptic period [s]
constexpr double kKept = 0.25;          // age of the oldest kept state [s]

TEST(HostClock, SumsUpTheStepsOfAHostInTime) {
  HostClock clock(kStep, 0.0);
  for (int i = 0; i < 200; ++i) {
    clock.follow(clock.time() + kStep, kStep);
    clock.endStep(kStep);
  }
  EXPECT_EQ(clock.time(), 200 * kStep);
  EXPECT_EQ(clock.timesSet(), 0u);
}

TEST(HostClock, BeginsAtTheFirstTickWithTheStepUnderWay) {
  HostClock fresh(0.0, 0.0);
  EXPECT_EQ(fresh.begin(5.0), 5.0);
  EXPECT_EQ(fresh.time(), 5.0);

  HostClock stepped(0.0, 0.0);
  for (int i = 0; i < 3; ++i) stepped.endStep(kStep);
  stepped.setStep(kStep);
  // The last step may be the one under way, so the first two are before the site's time.
  EXPECT_EQ(stepped.begin(5.0), 5.0 - 2 * kStep);
  EXPECT_EQ(stepped.time(), 5.0 + kStep);
}

TEST(HostClock, ALateHostMayCatchUpAndOneThatDroppedTimeMayNot) {
  constexpr double kStall = 0.25;
  HostClock clock(kStep, kStall);
  clock.follow(kStep + 0.5 + kStall, kStep);
  EXPECT_EQ(clock.time(), 0.0);
  EXPECT_EQ(clock.timesSet(), 0u);
  clock.follow(2.0, kStep);
  EXPECT_EQ(clock.time() + kStep, 2.0);
  EXPECT_EQ(clock.timesSet(), 1u);
}

TEST(HostClock, ALiveHostThatAsksForTheFutureGetsThePresent) {
  HostClock clock(kStep, 0.0);
  clock.endStep(1.0);
  clock.followLive(0.75, kStep, kKept, kTick);
  EXPECT_EQ(clock.time() + kStep, 0.75);
  EXPECT_FALSE(clock.hasJumped());
  EXPECT_EQ(clock.timesSet(), 0u);
}

TEST(HostClock, ALiveHostThatStoodStillIsSetOnAtOnce) {
  HostClock clock(kStep, 0.0);
  clock.followLive(kStep + kKept, kStep, kKept, kTick);
  EXPECT_EQ(clock.time(), 0.0);
  EXPECT_FALSE(clock.hasJumped());
  clock.followLive(3.0, kStep, kKept, kTick);
  EXPECT_EQ(clock.time() + kStep, 3.0);
  EXPECT_TRUE(clock.hasJumped());
  EXPECT_EQ(clock.timesSet(), 1u);
  clock.endStep(kStep);
  clock.followLive(3.0 + kStep, kStep, kKept, kTick);
  EXPECT_FALSE(clock.hasJumped());
  EXPECT_EQ(clock.timesSet(), 1u);
}

/// Runs a live host for 1 s, so late in each step; `in_time` is a step without lateness.
HostClock runLate(double late, int in_time = -1) {
  HostClock clock(kStep, 0.0);
  for (int i = 0; i < 64; ++i) {
    clock.followLive(clock.time() + kStep + (i == in_time ? 0.0 : late), kStep, kKept, kTick);
    clock.endStep(kStep);
  }
  return clock;
}

TEST(HostClock, ALiveHostThatIsAlwaysLateIsSetOnByTheLeastLateness) {
  const double late = 3 * kTick;
  const HostClock clock = runLate(late);
  EXPECT_EQ(clock.time(), 1.0 + late);
  EXPECT_EQ(clock.timesSet(), 1u);
  EXPECT_FALSE(clock.hasJumped());
}

TEST(HostClock, ALiveHostThatIsInTimeOnceASecondKeepsItsClock) {
  EXPECT_EQ(runLate(3 * kTick, 20).timesSet(), 0u);
  // Lateness within a tick is the ticks' own.
  EXPECT_EQ(runLate(kTick).timesSet(), 0u);
}

TEST(HostClock, LatenessRisesAtOnceAndDecaysSlowly) {
  HostClock clock(kStep, 0.0);
  clock.watchLateness(kStep + kTick + 0.01, kStep, kTick);
  EXPECT_NEAR(clock.lateness(), 0.01, 1e-15);
  // 20 ms per second of host time.
  for (int i = 1; i <= 16; ++i) {
    clock.watchLateness(kStep, kStep, kTick);
    ASSERT_NEAR(clock.lateness(), 0.01 - 0.02 * i * kStep, 1e-15);
  }
  clock.watchLateness(kStep + kTick + 0.02, kStep, kTick);
  EXPECT_NEAR(clock.lateness(), 0.02, 1e-15);
  for (int i = 0; i < 80; ++i) clock.watchLateness(kStep, kStep, kTick);
  EXPECT_EQ(clock.lateness(), 0.0);
}

}  // namespace
}  // namespace tandem
