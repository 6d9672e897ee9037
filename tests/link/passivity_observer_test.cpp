#include "tandem/coordination/passivity_observer.h"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "support/random.h"
#include "support/refusal.h"

namespace tandem {
namespace {

constexpr double kTank = 0.02, kBand = 0.01, kMost = 2.0;

TEST(PassivityObserver, LeavesTheForceAloneWhileEnoughIsLeft) {
  PassivityObserver observer;
  EXPECT_EQ(observer.computeShare({1e-3, 0.0}), 1.0);
  observer.addHand(-(kTank - kBand));
  EXPECT_NEAR(observer.available(), kBand, 1e-15);
  EXPECT_NEAR(observer.computeShare({1e-3, 0.0}), 1.0, 1e-12);
  EXPECT_EQ(observer.computeShare({-1.0, 0.0}), observer.computeShare({1e-3, 0.0}));
}

TEST(PassivityObserver, FadesTheForceWithWhatIsLeft) {
  PassivityObserver observer;
  observer.addHand(-kTank + 0.25 * kBand);
  EXPECT_NEAR(observer.computeShare({1e-6, 0.0}), 0.25, 1e-12);
  // The sign of the hand's power must not make a step in the share.
  EXPECT_EQ(observer.computeShare({-1e-6, 0.0}), observer.computeShare({1e-6, 0.0}));
}

TEST(PassivityObserver, OneTickTakesNoMoreThanMostOfWhatIsLeft) {
  PassivityObserver observer;
  EXPECT_NEAR(observer.computeShare({1.0, 0.0}) * 1.0, 0.8 * kTank, 2e-6);
  observer.addHand(-kTank);
  EXPECT_EQ(observer.computeShare({1e-9, 0.0}), 0.0);
}

TEST(PassivityObserver, CountsWhatWasGotWhenNothingWasLeft) {
  PassivityObserver observer;
  observer.addHand(-kTank - 0.003);
  EXPECT_NEAR(observer.overdrawn(), 0.003, 1e-15);
  observer.addHand(-0.001);
  EXPECT_NEAR(observer.overdrawn(), 0.004, 1e-15);
  // Energy that others absorbed is not energy that this hand got.
  observer.addHand(1.0);
  observer.addMoved(-0.5);
  EXPECT_NEAR(observer.overdrawn(), 0.004, 1e-15);
}

TEST(PassivityObserver, AnEmptyTankFillsAsTheHandPushes) {
  PassivityObserver observer;
  observer.addHand(-kTank);
  int ticks = 0;
  for (; observer.computeShare({-1e-3, 0.0}) < 1.0; ++ticks) {
    ASSERT_LT(ticks, 2000);
    observer.addHand(1e-3 * observer.computeShare({-1e-3, 0.0}));
  }
  EXPECT_GT(ticks, 10);
}

TEST(PassivityObserver, WhatOthersPutInMayBeGot) {
  PassivityObserver observer;
  observer.addMoved(0.1);
  observer.addHand(-0.1);
  EXPECT_EQ(observer.computeShare({1e-3, 0.0}), 1.0);
  EXPECT_EQ(observer.own(), -0.1);
  observer.addMoved(-kTank);  // granted
  EXPECT_EQ(observer.computeShare({1e-3, 0.0}), 0.0);
}

// An hour of friction must not pay for a blow afterwards.
TEST(PassivityObserver, HeatIsForgotten) {
  PassivityObserver observer;
  for (int i = 0; i < 1000; ++i) observer.addHand(1.0);
  EXPECT_NEAR(observer.available(), kTank + kMost, 1e-9);
  EXPECT_NEAR(observer.own(), 1000.0, 1e-9);
}

// A debt that is forgiven is energy from nowhere.
TEST(PassivityObserver, DebtsStay) {
  PassivityObserver observer;
  observer.addHand(-1.0);
  EXPECT_NEAR(observer.available(), kTank - 1.0, 1e-12);
  observer.addMoved(1.0);
  EXPECT_EQ(observer.computeShare({1e-3, 0.0}), 1.0);
}

// A hand that lifts a weight may get its energy back, although the weight has it now.
TEST(PassivityObserver, AWorldThatTookEnergyCountsAsZero) {
  PassivityObserver observer;
  observer.addHand(0.5);
  observer.addWorld(-0.5);
  EXPECT_NEAR(observer.available(), kTank + 0.5, 1e-15);
  EXPECT_EQ(observer.own(), 0.0);
  observer.addWorld(0.75);
  EXPECT_NEAR(observer.available(), kTank + 0.75, 1e-15);
}

// Motion that the force itself causes counts: the hand may be at rest, and light.
TEST(PassivityObserver, AForceThatMovesTheHandTakesNoMoreThanThereIs) {
  for (const double linear : {-0.02, -1e-4, 0.0, 1e-4, 0.02, 10.0}) {
    for (const double quadratic : {1e-6, 0.05, 600.0}) {
      for (const double left : {0.0, 1e-4, 5e-3, kTank}) {
        PassivityObserver observer;
        observer.addHand(left - kTank);
        const double share = observer.computeShare({linear, quadratic});
        EXPECT_GE(share, 0.0);
        EXPECT_LE(share, 1.0);
        EXPECT_LE(share * (linear + share * quadratic), 0.8 * left + 1e-15);
      }
    }
  }
}

TEST(PassivityObserver, WhatIsNoNumberDoesNotCount) {
  PassivityObserver observer;
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    observer.addHand(bad);
    observer.addHand(-bad);
    observer.addMoved(bad);
  }
  EXPECT_EQ(observer.own(), 0.0);
  EXPECT_EQ(observer.available(), kTank);
}

TEST(PassivityObserver, RefillsToTheTankAndNoFurther) {
  PassivityObserver observer;
  observer.addHand(-0.015);
  observer.refill();
  EXPECT_NEAR(observer.available(), kTank, 1e-15);
  EXPECT_NEAR(observer.own(), 0.0, 1e-15);
  observer.addHand(1.0);
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
      const double given = wanted * observer.computeShare({wanted, 0.0});
      observer.addHand(-given);
      got += given;
      const double more = random.uniform(0.0, 2e-4);
      observer.addMoved(more);
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
  EXPECT_NE(refusal([](auto& s) { s.power = -1.0; }).find("passivity.power = -1"),
            std::string::npos);
  EXPECT_NE(refusal([](auto& s) { s.least_mass = 0.0; }).find("passivity.least_mass = 0"),
            std::string::npos);
  EXPECT_EQ(refusal([](auto&) {}), "");
}

}  // namespace
}  // namespace tandem
