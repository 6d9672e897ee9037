#include "plugin/src/site/foresight.h"

#include <random>

#include <gtest/gtest.h>

namespace tandem {
namespace {

constexpr double kStep = 1.0 / 60.0;

Momentum upward(double impulse) { return {Vec3(0.0, 0.0, impulse), Vec3::Zero()}; }

Foresight makeForesight() {
  Foresight foresight;
  foresight.makeRoom();
  return foresight;
}

TEST(Foresight, ABlowDoesNotGoOn) {
  Foresight foresight = makeForesight();
  EXPECT_TRUE(foresight.expect(0.0, kStep, upward(0.5)).isZero());
  EXPECT_TRUE(foresight.isNone());
  EXPECT_TRUE(foresight.expect(kStep, kStep, {}).isZero());
  EXPECT_TRUE(foresight.expect(2.0 * kStep, kStep, upward(0.5)).isZero());
  EXPECT_TRUE(foresight.isNone());
}

TEST(Foresight, WhatLastsGoesOnWithHalfAheadAndEndsWithIt) {
  Foresight foresight = makeForesight();
  (void)foresight.expect(0.0, kStep, upward(0.1));
  // Of the smaller one.
  EXPECT_DOUBLE_EQ(foresight.expect(kStep, kStep, upward(0.3)).linear_W.z(), 0.05);
  EXPECT_DOUBLE_EQ(foresight.force().z(), 0.1 / kStep);
  const Foresight::Given given = foresight.take(kStep, 2.0 * kStep);
  EXPECT_DOUBLE_EQ(given.sum.linear_W.z(), 0.15);
  EXPECT_DOUBLE_EQ(given.mean.linear_W.z(), 0.05 + 0.1 / 2.0);
  EXPECT_TRUE(foresight.expect(2.0 * kStep, kStep, {}).isZero());
  EXPECT_TRUE(foresight.isNone());
  EXPECT_TRUE(foresight.take(2.0 * kStep, 3.0 * kStep).sum.isZero());
}

TEST(Foresight, APushTheOtherWayEndsIt) {
  Foresight foresight = makeForesight();
  (void)foresight.expect(0.0, kStep, upward(0.1));
  (void)foresight.expect(kStep, kStep, upward(0.1));
  EXPECT_TRUE(foresight.expect(2.0 * kStep, kStep, upward(-0.1)).isZero());
  EXPECT_TRUE(foresight.isNone());
}

// Host steps come early or late beside the ticks. Their windows count each impulse once.
TEST(Foresight, LosesAndMakesNoMomentum) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> impulse(0.05, 0.2), late(0.0, 1.5);
  Foresight foresight = makeForesight();
  double counted = 0.0, given = 0.0, now = 0.0;
  for (int n = 0; n < 1000; ++n) {
    const double end = (n + 1) * kStep;
    counted += foresight.take(n * kStep, end).sum.linear_W.z();
    const double next = std::max(now, end + late(random) * kStep);
    given += (next - now) * foresight.force().z();
    now = next;
    given += foresight.expect(now, kStep, upward(impulse(random))).linear_W.z();
  }
  foresight.end(now);
  for (int n = 1000; n < 1004; ++n)
    counted += foresight.take(n * kStep, (n + 1) * kStep).sum.linear_W.z();
  EXPECT_NEAR(counted, given, 1e-9 * given);
}

}  // namespace
}  // namespace tandem
