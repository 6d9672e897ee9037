#include "coordination/src/island/virtual_coupler.h"

#include <cstdint>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "support/random.h"

namespace tandem {
namespace {

constexpr CouplerGains kCoordination{200.0, 30.0};  // [N/m], [N s/m]
constexpr CouplerGains kContact{4000.0, 1.0};       // [N/m], [N s/m]
constexpr std::uint64_t kSeed = 7;

PointState drawState(test::Random& random) {
  const Vec3 p_W = random.inCube(1.0);
  return {p_W, random.inCube(1.0)};
}

TEST(VirtualCoupler, PullsFollowerTowardsLeader) {
  const PointState leader{Vec3(0.01, 0.0, -0.02), Vec3::Zero()};
  const Vec3 force = computeCouplerForce(kCoordination, leader, PointState{});
  EXPECT_NEAR((force - Vec3(2.0, 0.0, -4.0)).norm(), 0.0, 1e-14);
}

TEST(VirtualCoupler, DragsFollowerAlongWithLeader) {
  const PointState leader{Vec3::Zero(), Vec3(0.1, -0.2, 0.0)};
  const Vec3 force = computeCouplerForce(kCoordination, leader, PointState{});
  EXPECT_NEAR((force - Vec3(3.0, -6.0, 0.0)).norm(), 0.0, 1e-14);
}

TEST(VirtualCoupler, RestsWhereBothAgree) {
  const PointState state{Vec3(1.0, 2.0, 3.0), Vec3(-4.0, 5.0, 6.0)};
  EXPECT_EQ(computeCouplerForce(kCoordination, state, state), Vec3::Zero());
}

TEST(VirtualCoupler, WithoutGainsThereIsNoForce) {
  test::Random random(kSeed);
  const PointState leader = drawState(random), follower = drawState(random);
  EXPECT_EQ(computeCouplerForce({}, leader, follower), Vec3::Zero());
}

// Exact: rounding is symmetric, so one body gains exactly the momentum that the other loses.
TEST(VirtualCoupler, ReactionIsOppositeToTheLastBit) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  test::Random random(kSeed);
  for (int i = 0; i < 1000; ++i) {
    const PointState a = drawState(random), b = drawState(random);
    EXPECT_EQ(computeCouplerForce(kCoordination, a, b), -computeCouplerForce(kCoordination, b, a));
  }
}

TEST(VirtualCoupler, DampingNeverFeedsTheMotionBetweenBoth) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  test::Random random(kSeed);
  for (int i = 0; i < 1000; ++i) {
    const PointState leader = drawState(random), follower = drawState(random);
    const Vec3 force = computeCouplerForce({0.0, 30.0}, leader, follower);
    const double power =
        force.dot(follower.v_W) - force.dot(leader.v_W);  // power into both bodies [W]
    EXPECT_LE(power, 0.0);
  }
}

// The force turns with the scene. A common shift or drift has no effect.
TEST(VirtualCoupler, SeesOnlyTheRelativeState) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  test::Random random(kSeed);
  for (int i = 0; i < 1000; ++i) {
    const PointState leader = drawState(random), follower = drawState(random);
    const Vec3 shift = random.inCube(1.0), drift = random.inCube(1.0);
    const Quat turn(Eigen::AngleAxisd(3.0 * shift.x(), drift.normalized()));
    const auto move = [&](const PointState& s) {
      return PointState{turn * s.p_W + shift, turn * s.v_W + drift};
    };
    const Vec3 force = computeCouplerForce(kCoordination, leader, follower);
    const Vec3 moved = computeCouplerForce(kCoordination, move(leader), move(follower));
    // States of size 3 times K = 200 N/m carry rounding of about 600 N x 1e-16.
    EXPECT_NEAR((moved - turn * force).norm(), 0.0, 2e-12);
  }
}

TEST(ContactForce, IsSpringAndDamperWhileBodiesOverlap) {
  EXPECT_DOUBLE_EQ(computeContactForce(kContact, 0.001, 0.0), 4.0);
  EXPECT_DOUBLE_EQ(computeContactForce(kContact, 0.001, 0.5), 4.5);
  EXPECT_DOUBLE_EQ(computeContactForce(kContact, 0.001, -0.5), 3.5);
}

TEST(ContactForce, IsZeroWhileBodiesAreApart) {
  for (const double overlap : {-1.0, -1e-12, -0.0, 0.0})
    for (const double rate : {-10.0, 0.0, 10.0})
      EXPECT_EQ(computeContactForce(kContact, overlap, rate), 0.0) << overlap << ' ' << rate;
}

// A plain damper would pull back bodies that part faster than K overlap / B.
TEST(ContactForce, NeverPulls) {
  const double fastest = 4000.0 * 0.001 / 1.0;  // [m/s]
  EXPECT_GT(computeContactForce(kContact, 0.001, -0.99 * fastest), 0.0);
  EXPECT_EQ(computeContactForce(kContact, 0.001, -1.01 * fastest), 0.0);
  EXPECT_EQ(computeContactForce(kContact, 0.001, -1e6), 0.0);
}

TEST(ContactForce, IsZeroForNoNumber) {
  const double no_number = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(computeContactForce(kContact, no_number, 0.0), 0.0);
  EXPECT_EQ(computeContactForce(kContact, 0.001, no_number), 0.0);
}

// Experiment I at rest: 5 N through one contact of 4000 N/m press 1.25 mm deep, with either body as
// the lower one.
TEST(ContactForce, HoldsTheHandOfExperimentOne) {
  const double x1 = 0.00125, xo1 = 0.0;  // eq. (7): user 1 pushes the cube
  EXPECT_DOUBLE_EQ(computeContactForce(kContact, x1 - xo1, 0.0), 5.0);
}

}  // namespace
}  // namespace tandem
