#include "tandem/coordination/passivity_observer.h"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "support/random.h"
#include "support/refusal.h"

namespace tandem {
namespace {

constexpr double kTank = 0.02, kBand = 0.01, kMost = 10.0;

TEST(PassivityObserver, LeavesTheForceAloneWhileEnoughIsLeft) {
  PassivityObserver observer;
  EXPECT_EQ(observer.computeShare(1e-3), 1.0);
  observer.addOwn(-(kTank - kBand));
  EXPECT_NEAR(observer.available(), kBand, 1e-15);
  EXPECT_NEAR(observer.computeShare(1e-3), 1.0, 1e-12);
  EXPECT_EQ(observer.computeShare(-1.0), observer.computeShare(1e-3));
}

TEST(PassivityObserver, FadesTheForceWithWhatIsLeft) {
  PassivityObserver observer;
  observer.addOwn(-kTank + 0.25 * kBand);
  EXPECT_NEAR(observer.computeShare(1e-6), 0.25, 1e-12);
  // The sign of the hand's power must not make a step in the share.
  EXPECT_EQ(observer.computeShare(-1e-6), observer.computeShare(1e-6));
}

TEST(PassivityObserver, OneTickTakesNoMoreThanThereIs) {
  PassivityObserver observer;
  EXPECT_NEAR(observer.computeShare(1.0) * 1.0, kTank, 1e-15);
  observer.addOwn(-kTank);
  EXPECT_EQ(observer.computeShare(1e-9), 0.0);
}

TEST(PassivityObserver, CountsWhatWasGotWhenNothingWasLeft) {
  PassivityObserver observer;
  observer.addOwn(-kTank - 0.003);
  EXPECT_NEAR(observer.overdrawn(), 0.003, 1e-15);
  observer.addOwn(-0.001);
  EXPECT_NEAR(observer.overdrawn(), 0.004, 1e-15);
  // Energy that others absorbed is not energy that this hand got.
  observer.addOwn(1.0);
  observer.addReported(-5.0);
  EXPECT_NEAR(observer.overdrawn(), 0.004, 1e-15);
}

TEST(PassivityObserver, AnEmptyTankFillsAsTheHandPushes) {
  PassivityObserver observer;
  observer.addOwn(-kTank);
  int ticks = 0;
  for (; observer.computeShare(-1e-3) < 1.0; ++ticks) {
    ASSERT_LT(ticks, 2000);
    observer.addOwn(1e-3 * observer.computeShare(-1e-3));
  }
  EXPECT_GT(ticks, 10);
}

TEST(PassivityObserver, WhatOthersPutInMayBeGot) {
  PassivityObserver observer;
  observer.addReported(0.1);
  observer.addOwn(-0.1);
  EXPECT_EQ(observer.computeShare(1e-3), 1.0);
  EXPECT_EQ(observer.own(), -0.1);
  observer.addReported(-0.1);  // the peer takes it out again
  EXPECT_NEAR(observer.available(), -kTank, 1e-15);
  EXPECT_EQ(observer.computeShare(1e-3), 0.0);
}

// An hour of friction must not pay for a blow afterwards.
TEST(PassivityObserver, HeatIsForgotten) {
  PassivityObserver observer;
  for (int i = 0; i < 1000; ++i) observer.addOwn(1.0);
  EXPECT_NEAR(observer.available(), kTank + kMost, 1e-9);
  EXPECT_NEAR(observer.own(), 1000.0, 1e-9);
}

TEST(PassivityObserver, DebtsCountToOneTank) {
  PassivityObserver observer;
  observer.addReported(-1000.0);
  EXPECT_NEAR(observer.available(), -kTank, 1e-12);
  observer.addOwn(2.0 * kTank);
  EXPECT_EQ(observer.computeShare(1e-3), 1.0);
}

TEST(PassivityObserver, WhatIsNoNumberDoesNotCount) {
  PassivityObserver observer;
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    observer.addOwn(bad);
    observer.addOwn(-bad);
    observer.addReported(bad);
  }
  EXPECT_EQ(observer.own(), 0.0);
  EXPECT_EQ(observer.available(), kTank);
}

TEST(PassivityObserver, RefillsToTheTankAndNoFurther) {
  PassivityObserver observer;
  observer.addOwn(-0.015);
  observer.refill();
  EXPECT_NEAR(observer.available(), kTank, 1e-15);
  EXPECT_NEAR(observer.own(), 0.0, 1e-15);
  observer.addOwn(1.0);
  observer.refill();
  EXPECT_NEAR(observer.available(), kTank + 1.0, 1e-15);
  EXPECT_NEAR(observer.lowest(), kTank - 0.015, 1e-15);
}

// Holds for any force and motion. A hand that moves in a tick as predicted never gets more than the
// tank and the reported energy.
TEST(PassivityObserver, HoldsForDrawnForces) {
  constexpr std::uint64_t kSeed = 41;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  for (int round = 0; round < 200; ++round) {
    PassivityObserver observer;
    double got = 0.0, reported = 0.0;
    for (int tick = 0; tick < 2000; ++tick) {
      const double wanted = random.uniform(-0.02, 0.05);
      const double given = wanted * observer.computeShare(wanted);
      observer.addOwn(-given);
      got += given;
      const double more = random.uniform(0.0, 2e-4);
      observer.addReported(more);
      reported += more;
      ASSERT_LE(got, kTank + reported + 1e-12);
      ASSERT_GE(observer.available(), -1e-12);
    }
  }
}

TEST(PassivitySettings, BadOnesAreRefusedByName) {
  const auto refusal = [](auto spoil) { return test::refusalOf(&checkPassivitySettings, spoil); };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal([](auto& s) { s.tank = 0.0; }).find("passivity.tank = 0"), std::string::npos);
  EXPECT_NE(refusal([&](auto& s) { s.tank = nan; }).find("passivity.tank"), std::string::npos);
  EXPECT_NE(refusal([](auto& s) { s.band = 1.0; }).find("passivity.band = 1"), std::string::npos);
  EXPECT_NE(refusal([](auto& s) { s.most = -1.0; }).find("passivity.most = -1"), std::string::npos);
  EXPECT_EQ(refusal([](auto&) {}), "");
}

}  // namespace
}  // namespace tandem
