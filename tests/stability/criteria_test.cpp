// Textbook criteria: their closed forms, and how far they are from the exact border.
#include "demos/program/analyse/criteria.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tandem/coordination/stability_advice.h"

namespace tandem {
namespace {

using namespace demos;

constexpr double kPacketRate = 128.0;  // [Hz]

// Two users of virtual coupling in Experiment I: device and half of the cube, B_t.
constexpr DelayedChain kCoupled{0.2, 0.5, 30.0};
// A hand at a kinematic proxy in Experiment II: the device, B_vc.
constexpr DelayedChain kTouching{0.1, 0.5, 1.0};

TEST(Criteria, ChainAllowsLessTheLongerTheDelay) {
  const auto limit = [](const DelayedChain& chain, double delay) {
    return limitByChain(chain, computeAge(delay, kPacketRate));
  };
  EXPECT_NEAR(limit(kCoupled, 0.02), 1152.0, 0.6);  // [N/m]
  EXPECT_NEAR(limit(kCoupled, 0.05), 346.0, 0.6);
  EXPECT_NEAR(limit(kCoupled, 0.1), 157.0, 0.6);
  EXPECT_NEAR(limit(kCoupled, 0.2), 97.9, 0.06);
  EXPECT_NEAR(limit(kTouching, 0.02), 101.2, 0.06);
  EXPECT_NEAR(limit(kTouching, 0.05), 43.86, 0.006);
  EXPECT_NEAR(limit(kTouching, 0.1), 22.72, 0.006);
  EXPECT_NEAR(limit(kTouching, 0.2), 12.59, 0.006);
}

TEST(Criteria, BelowTheLimitOfEveryDelayNoDelayIsTooLong) {
  EXPECT_NEAR(limitAtEveryDelay(kCoupled), 75.625, 1e-9);  // [N/m]
  EXPECT_NEAR(limitAtEveryDelay(kTouching), 6.25, 1e-9);
  EXPECT_EQ(computeCriticalDelay(kCoupled, 75.6), HUGE_VAL);
  EXPECT_LT(computeCriticalDelay(kCoupled, 80.0), 1.0);
  EXPECT_GT(limitByChain(kCoupled, 10.0), 75.625);
  EXPECT_LT(limitByChain(kCoupled, 10.0), 75.7);
}

// A copy of 0.1 kg, held by 200 N/m and 2 N s/m to another: 20.58 ms with the age of packets.
TEST(Criteria, CriticalDelayIsThatOfTheChainAlone) {
  const DelayedChain copies{0.1, 0.5, 2.0};
  EXPECT_NEAR(computeCriticalDelay(copies, 200.0), 20.578e-3, 1e-6);
  EXPECT_NEAR(limitByChain(copies, 20.578e-3), 200.0, 0.02);
}

// Weight n counts as n springs and n dampers.
TEST(Criteria, ManyOthersAreOneStrongOne) {
  const DelayedChain three{0.1, 0.5, 2.0, 3.0}, one{0.1, 0.5, 6.0};
  EXPECT_NEAR(limitAtEveryDelay(three), limitAtEveryDelay(one) / 3.0, 1e-9);
  EXPECT_NEAR(computeCriticalDelay(three, 100.0), computeCriticalDelay(one, 300.0), 1e-12);
}

TEST(Criteria, OthersAreTheirClosedForms) {
  EXPECT_NEAR(limitByGroundedDamper(0.5, computeAge(0.05, kPacketRate)), 9.3, 0.05);  // [N/m]
  EXPECT_NEAR(limitByWall(0.5, 1.0, 1e-3), 3000.0, 1e-9);
  EXPECT_NEAR(limitByColgateSchenkel(3.0, 1.0, 1e-3), 4000.0, 1e-9);
  EXPECT_NEAR(limitByColgateSchenkel(2.0, 1.0, 1e-3), 2000.0, 1e-9);
  EXPECT_LT(limitByColgateSchenkel(0.5, 1.0, 1e-3), 0.0);  // allows none
}

// The exact borders that they are compared with.
TEST(Criteria, AreNotTheExactBorder) {
  LoopSettings coupled;
  coupled.stand_in = StandInKind::kNone;
  LoopSettings touching;
  touching.stand_in = StandInKind::kHeld;
  touching.has_object = false;
  touching.contact = {2000.0, 1.0};
  const auto expectBorder = [](LoopSettings loop, LoopGain gain, double delay, double border) {
    loop.delay = delay;
    setValue(loop, gain, 0.999 * border);
    EXPECT_LT(computeWorstRate(loop), 0.0) << border;
    setValue(loop, gain, 1.001 * border);
    EXPECT_GT(computeWorstRate(loop), 0.0) << border;
  };
  expectBorder(coupled, LoopGain::kCoordinationStiffness, 0.02, 1598.0);
  expectBorder(coupled, LoopGain::kCoordinationStiffness, 0.05, 389.45);
  expectBorder(coupled, LoopGain::kCoordinationStiffness, 0.1, 178.8);
  expectBorder(coupled, LoopGain::kCoordinationStiffness, 0.2, 104.5);
  expectBorder(touching, LoopGain::kContactStiffness, 0.05, 42.99);
  expectBorder(touching, LoopGain::kContactStiffness, 0.1, 22.42);
}

}  // namespace
}  // namespace tandem
