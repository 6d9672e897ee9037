#include "replay/replay_clock.h"

#include <gtest/gtest.h>

namespace tandem::view {
namespace {

const std::vector<double> kFrames = {0.0, 0.5, 1.0};

TEST(ReplayClock, PlaysToTheEndAndAgainFromTheBeginning) {
  ReplayClock clock(kFrames, 1.2);
  EXPECT_TRUE(clock.isPlaying());
  clock.advance(0.4);
  EXPECT_DOUBLE_EQ(clock.time(), 0.4);
  clock.speed = 0.5;
  clock.advance(0.4);
  EXPECT_DOUBLE_EQ(clock.time(), 0.6);
  clock.advance(9.0);
  EXPECT_EQ(clock.time(), 1.2);
  EXPECT_FALSE(clock.isPlaying());
  clock.toggle();
  EXPECT_TRUE(clock.isPlaying());
  EXPECT_EQ(clock.time(), 0.0);
}

TEST(ReplayClock, PausesWhereItIs) {
  ReplayClock clock(kFrames, 1.2);
  clock.advance(0.3);
  clock.toggle();
  clock.advance(0.3);
  EXPECT_DOUBLE_EQ(clock.time(), 0.3);
  clock.toggle();
  clock.advance(0.3);
  EXPECT_DOUBLE_EQ(clock.time(), 0.6);
}

TEST(ReplayClock, StepsFromPictureToPicture) {
  ReplayClock clock(kFrames, 1.2);
  clock.advance(0.6);
  clock.step(-1);
  EXPECT_FALSE(clock.isPlaying());
  EXPECT_EQ(clock.time(), 0.5);
  clock.step(-1);
  clock.step(-1);
  EXPECT_EQ(clock.time(), 0.0);
  for (double time : {0.5, 1.0, 1.2, 1.2}) {
    clock.step(1);
    EXPECT_EQ(clock.time(), time);
  }
}

TEST(ReplayClock, StaysWithinTheRun) {
  ReplayClock clock(kFrames, 1.2);
  clock.seek(-1.0);
  EXPECT_EQ(clock.time(), 0.0);
  clock.seek(7.0);
  EXPECT_EQ(clock.time(), 1.2);
}

}  // namespace
}  // namespace tandem::view
