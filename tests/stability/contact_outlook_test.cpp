// Restitution of a touch, and whether contact lasts: as runs of Experiment II show it.
#include "tandem/coordination/contact_outlook.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "stability/papers_loops.h"

namespace tandem {
namespace {

/// Experiment II with another contact and device.
LoopSettings makeTouch(StandInKind kind, double stiffness, double device_damping) {
  LoopSettings settings = test::makeSecondExperiment(kind);
  settings.contact.stiffness = stiffness;
  settings.device_damping = device_damping;
  return settings;
}

/// `changes`: of contact in a run until it rests.
struct Wall {
  double stiffness, device_damping, restitution;
  int changes;
};

TEST(ContactOutlook, OfAWallIsThatOfRuns) {
  const Wall walls[] = {{2000, 0.25, 0.974, 47}, {2000, 0.5, 0.946, 25}, {2000, 1, 0.893, 13},
                        {2000, 2, 0.794, 5},     {500, 0.5, 0.768, 7},   {1000, 0.5, 0.859, 11},
                        {1000, 1, 0.793, 7},     {3000, 1, 0.951, 27},   {3000, 2, 0.863, 9},
                        {4000, 2, 0.911, 15}};
  for (const Wall& wall : walls) {
    const auto outlook =
        computeOutlook(makeTouch(StandInKind::kHeld, wall.stiffness, wall.device_damping));
    EXPECT_NEAR(outlook.restitution, wall.restitution, 6e-4) << wall.stiffness;
    ASSERT_TRUE(outlook.changes);
    EXPECT_NEAR(*outlook.changes, wall.changes, 2.0 + 0.1 * wall.changes) << wall.stiffness;
  }
}

TEST(ContactOutlook, TellsOfTouchesThatGainEnergy) {
  for (const auto& [stiffness, damping] : {std::pair{2000.0, 0.0}, {4000.0, 0.5}}) {
    const auto outlook = computeOutlook(makeTouch(StandInKind::kHeld, stiffness, damping));
    EXPECT_GT(outlook.restitution, 1.0);
    EXPECT_FALSE(outlook.changes);
  }
}

// A pair of equal bodies that meet without a hold and a delay: K and B decide, and half of m.
TEST(ContactOutlook, OfTwoEqualBodiesIsThatOfTheirSpring) {
  LoopSettings settings = makeTouch(StandInKind::kDynamic, 50.0, 0.0);
  settings.coordination = {0.0, 0.0};
  settings.contact.damping = 0.05;
  const double m = 0.5 * settings.device_mass, K = 50.0, B = 0.05;
  const double decay = B / (2.0 * m), turn = std::sqrt(K / m - decay * decay);
  // Contact ends when K x + B v = 0: a little before the bodies' distance is that of before.
  const double time = (3.14159265358979 - 2.0 * std::asin(decay / std::sqrt(K / m))) / turn;
  const double apart = std::exp(-decay * time);  // of their velocity, near enough
  EXPECT_NEAR(computeRestitution(settings), 0.5 * (apart - 1.0), 0.01);
}

TEST(ContactOutlook, LastsWhereMotionDiesOut) {
  EXPECT_TRUE(computeOutlook(makeTouch(StandInKind::kDynamic, 2000, 0.5)).comes_and_goes);
  EXPECT_TRUE(computeOutlook(makeTouch(StandInKind::kDynamic, 2000, 2.5)).comes_and_goes);
  EXPECT_FALSE(computeOutlook(makeTouch(StandInKind::kDynamic, 2000, 3.0)).comes_and_goes);
  EXPECT_TRUE(computeOutlook(makeTouch(StandInKind::kHeld, 2000, 19.0)).comes_and_goes);
  EXPECT_FALSE(computeOutlook(makeTouch(StandInKind::kHeld, 2000, 20.0)).comes_and_goes);
}

TEST(ContactOutlook, RefusesAnObject) {
  EXPECT_THROW((void)computeOutlook(LoopSettings{}), std::invalid_argument);
}

}  // namespace
}  // namespace tandem
