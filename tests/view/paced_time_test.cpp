// Pause, slow motion and single steps, by a clock of the test's own.

#include "session/paced_time.h"

#include <gtest/gtest.h>

#include "view/own_world.h"

namespace tandem::view {
namespace {

class PacedTimeTest : public ::testing::Test {
 protected:
  /// Lets `length` [s] of the clock pass in turns of 1 ms.
  void pass(PacedTime& time, double length, const Pace& pace) {
    const int turns = static_cast<int>(length * 1e3 + 0.5);
    for (int turn = 0; turn < turns; ++turn) time.advance(kBegin + 1e-3 * ++turns_, pace);
  }

  static constexpr double kBegin = 5000.0;  // [s]
  demos::Scenario scenario = tandem::test::loadWorld("cube");
  SitePair pair{scenario};

 private:
  int turns_ = 0;
};

TEST_F(PacedTimeTest, HalfTheSpeedIsHalfTheTicks) {
  const Pace half{0.5, false}, tenth{0.1, false}, full;
  PacedTime time(pair, kBegin, half);
  pass(time, 1.0, half);
  EXPECT_EQ(pair.nextTick(), 500u);
  pass(time, 1.0, tenth);  // the turn in which the pace changes makes no tick
  EXPECT_NEAR(static_cast<double>(pair.nextTick()), 600.0, 1.0);
  pass(time, 1.0, full);
  EXPECT_NEAR(static_cast<double>(pair.nextTick()), 1600.0, 2.0);
}

TEST_F(PacedTimeTest, StandsWhilePausedAndStepsOneHostPeriod) {
  const Pace full, paused{1.0, true};
  PacedTime time(pair, kBegin, full);
  pass(time, 1.205, full);
  pass(time, 0.001, paused);
  EXPECT_EQ(pair.nextTick(), 1217u) << "a pause begins with the end of a host step";
  const std::uint64_t hash = pair.own().site().stateHash();
  const Vec3 force_W = pair.own().site().force();
  ASSERT_GT(force_W.norm(), 0.1);
  pass(time, 10.0, paused);
  EXPECT_EQ(pair.nextTick(), 1217u);
  EXPECT_EQ(pair.own().site().stateHash(), hash);
  EXPECT_EQ(pair.own().site().force(), force_W) << "the force stays as shown";

  time.advance(kBegin + 12.0, paused, 1);
  EXPECT_EQ(pair.nextTick(), 1234u);
  EXPECT_EQ(pair.own().site().counters().host_steps, 74u);
  time.advance(kBegin + 12.1, paused, 2);
  EXPECT_EQ(pair.own().site().counters().host_steps, 76u);
}

TEST_F(PacedTimeTest, AfterAPauseTheForceGoesOnWithinTheSlew) {
  const Pace full, paused{1.0, true};
  PacedTime time(pair, kBegin, full);
  pass(time, 1.2, full);
  pass(time, 1.0, paused);
  pass(time, 0.001, full);  // begins anew
  Vec3 last_W = pair.own().site().force();
  ASSERT_EQ(pair.nextTick(), 1217u);
  for (int tick = 0; tick < 100; ++tick) {
    pass(time, 0.001, full);
    const Vec3& force_W = pair.own().site().force();
    EXPECT_LE((force_W - last_W).norm(), scenario.site.max_slew * pair.period());
    last_W = force_W;
  }
  EXPECT_NEAR(static_cast<double>(pair.nextTick()), 1317.0, 1.0);
}

TEST_F(PacedTimeTest, APauseAtTheBeginningSettlesFirst) {
  const Pace paused{1.0, true};
  PacedTime time(pair, kBegin, paused);
  EXPECT_EQ(pair.nextTick(), 34u) << "20 ms, and the rest of a host step";
  pass(time, 1.0, paused);
  EXPECT_EQ(pair.nextTick(), 34u);
}

TEST_F(PacedTimeTest, ASlowMachineDropsTime) {
  const Pace full;
  PacedTime time(pair, kBegin, full);
  time.advance(kBegin + 3.0, full);
  EXPECT_NEAR(static_cast<double>(pair.nextTick()), 20.0, 1.0);
  time.advance(kBegin + 3.005, full);
  EXPECT_NEAR(static_cast<double>(pair.nextTick()), 25.0, 1.0);
}

}  // namespace
}  // namespace tandem::view
