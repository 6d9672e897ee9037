// Private header of the plugin: how near things are to hands.
#include "plugin/src/site/nearness.h"

#include <cmath>

#include <gtest/gtest.h>

namespace tandem {
namespace {

MovingBall at(double x, double v = 0.0, double radius = 0.0) {
  return {Vec3(x, 0, 0), Vec3(v, 0, 0), radius};
}

TEST(Nearness, GapIsBetweenSurfaces) {
  EXPECT_NEAR(computeGapSoon(at(0, 0, 0.01), at(0.1, 0, 0.02)), 0.07, 1e-15);
  EXPECT_NEAR(computeGapSoon(at(0.3, 0, 0.01), at(0.3, 0, 0.02)), -0.03, 1e-15);
}

TEST(Nearness, ForeseesAnApproachAndNoRetreat) {
  EXPECT_NEAR(computeGapSoon(at(0, 0.4), at(0.5)), 0.4, 1e-15);
  EXPECT_NEAR(computeGapSoon(at(0), at(0.5, -0.4)), 0.4, 1e-15);
  EXPECT_NEAR(computeGapSoon(at(0, -0.4), at(0.5)), 0.5, 1e-15);
  const MovingBall aside{Vec3(0, 0, 0), Vec3(0, 2, 0), 0.0};
  EXPECT_NEAR(computeGapSoon(aside, at(0.5)), 0.5, 1e-15);
}

TEST(Nearness, WhatIsNearStaysSoUpToAWiderGap) {
  EXPECT_EQ(computeNearness(0.031, Nearness::kFar), Nearness::kNear);
  EXPECT_EQ(computeNearness(0.031, Nearness::kTouch), Nearness::kTouch);
  EXPECT_EQ(computeNearness(0.21, Nearness::kFar), Nearness::kFar);
  EXPECT_EQ(computeNearness(0.21, Nearness::kTouch), Nearness::kNear);
  EXPECT_EQ(computeNearness(0.27, Nearness::kTouch), Nearness::kFar);
}

TEST(Nearness, ReachIsThatOfWhatIsHeld) {
  Reach reach{at(0), std::nullopt};
  EXPECT_NEAR(reach.computeGapSoon(at(1)), 1.0, 1e-15);
  reach.held = at(0.3, 0, 0.2);
  EXPECT_NEAR(reach.computeGapSoon(at(1)), 0.5, 1e-15);
}

TEST(Nearness, RisesAtOnceAndFallsAfterACalm) {
  HeldNearness held;
  held.update(0.0, 1.0);
  EXPECT_EQ(held.value(), Nearness::kTouch);
  held.update(1.0, 1.0 + HeldNearness::kCalm - 1e-6);
  EXPECT_EQ(held.value(), Nearness::kTouch);
  held.update(1.0, 1.0 + HeldNearness::kCalm + 1e-6);
  EXPECT_EQ(held.value(), Nearness::kFar);
}

// A hand that trembles at the edge of the reach, or touches again and again, changes nothing.
TEST(Nearness, DoesNotFlicker) {
  HeldNearness trembling, tapping;
  for (int i = 0; i < 2000; ++i) {
    const double t = 1e-3 * i;
    trembling.update(0.03 + 0.005 * std::cos(60.0 * t), t);
    tapping.update(0.05 - 0.05 * std::cos(30.0 * t), t);
    if (t < 0.11) continue;
    ASSERT_EQ(trembling.value(), Nearness::kTouch) << t;
    ASSERT_EQ(tapping.value(), Nearness::kTouch) << t;
  }
}

}  // namespace
}  // namespace tandem
