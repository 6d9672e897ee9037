#include "tandem/falcon/pointer_plane.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "support/random.h"

namespace tandem {
namespace {

const Vec3 kEye_W(0.0, -0.4, 0.3);  // looks at the origin from the front and above

PointerRay rayThrough(const Vec3& p_W) { return {kEye_W, p_W - kEye_W}; }

TEST(PointerPlane, LevelPlaneKeepsTheHeight) {
  const PointerPlane plane = makeLevelPlane(Vec3(0.1, 0.0, 0.05));
  const auto target_W = computePointerTarget(rayThrough(Vec3(-0.1, 0.2, 0.05)), plane, {});
  ASSERT_TRUE(target_W);
  EXPECT_LT((*target_W - Vec3(-0.1, 0.2, 0.05)).norm(), 1e-15);
}

TEST(PointerPlane, UprightPlaneFacesTheEye) {
  const auto plane = makeUprightPlane(Vec3(0.1, 0.05, 0.0), Vec3(0, 4, -3));
  ASSERT_TRUE(plane);
  EXPECT_EQ(plane->n_W, Vec3(0, 1, 0)) << "away from the eye, level";
  const auto target_W = computePointerTarget(rayThrough(Vec3(-0.1, 0.05, 0.2)), *plane, {});
  ASSERT_TRUE(target_W);
  EXPECT_LT((*target_W - Vec3(-0.1, 0.05, 0.2)).norm(), 1e-15);
}

TEST(PointerPlane, UprightPlaneNeedsALevelPartOfTheLook) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const Vec3& look_W :
       {Vec3(0, 0, -1), Vec3(0, 0.04, -1), Vec3(0, 0, 0), Vec3(kNan, 1, 0), Vec3(0, kInfinity, 0)})
    EXPECT_FALSE(makeUprightPlane(Vec3::Zero(), look_W)) << look_W.transpose();
  EXPECT_TRUE(makeUprightPlane(Vec3::Zero(), Vec3(0, 0.06, -1)));
  EXPECT_TRUE(makeUprightPlane(Vec3::Zero(), Vec3(1e200, 0, -1e200))) << "of any length";
}

TEST(PointerPlane, TargetIsInThePlaneAndOnTheRay) {
  const std::uint64_t seed = 11;
  SCOPED_TRACE("seed " + std::to_string(seed));
  test::Random random(seed);
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    const PointerPlane plane{random.inCube(0.2), random.direction()};
    const PointerRay ray{random.inCube(1.0), random.logUniform(1e-150, 1e150) * random.direction()};
    const auto target_W = computePointerTarget(ray, plane, {Vec3::Zero(), 10.0});
    if (!target_W) continue;
    ++found;
    const Vec3 way_W = *target_W - ray.eye_W;
    const Vec3 d = ray.direction_W.stableNormalized();
    ASSERT_NEAR((*target_W - plane.p_W).dot(plane.n_W), 0.0, 1e-13);
    ASSERT_NEAR(way_W.cross(d).norm(), 0.0, 1e-13);
    ASSERT_GT(way_W.dot(d), 0.0);
  }
  EXPECT_GT(found, 500);
}

TEST(PointerPlane, PointerThatComesBackBringsTheTargetBack) {
  Vec3 target_W = Vec3::Zero();
  const Vec3 look_W = -kEye_W;
  const PointerRay rays[] = {rayThrough(Vec3(0.2, 0, 0.1)), rayThrough(Vec3(0.1, 0, -0.1)),
                             rayThrough(Vec3(-0.2, 0, 0.05)), rayThrough(Vec3::Zero())};
  for (const PointerRay& ray : rays) {
    const auto moved_W = computePointerTarget(ray, *makeUprightPlane(target_W, look_W), {});
    ASSERT_TRUE(moved_W);
    target_W = *moved_W;
  }
  EXPECT_LT(target_W.norm(), 1e-15);
}

TEST(PointerPlane, RefusesRaysThatMeanNothing) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const PointerPlane level = makeLevelPlane(Vec3::Zero());
  EXPECT_TRUE(computePointerTarget({Vec3(0, 0, 0.01), Vec3(0, 1, -0.0501)}, level, {}));
  EXPECT_FALSE(computePointerTarget({Vec3(0, 0, 0.01), Vec3(0, 1, -0.0499)}, level, {}))
      << "nearly in the plane";
  EXPECT_FALSE(computePointerTarget({kEye_W, Vec3(0, 1, 0)}, level, {})) << "in the plane";
  EXPECT_FALSE(computePointerTarget({kEye_W, Vec3(0, 0.4, 0.3)}, level, {})) << "behind the eye";
  EXPECT_FALSE(computePointerTarget({Vec3::Zero(), Vec3(0, 0, -1)}, level, {})) << "at the eye";
  EXPECT_FALSE(computePointerTarget(rayThrough(Vec3(0.3, 0.3, 0)), level, {})) << "out of reach";
  EXPECT_FALSE(computePointerTarget({kEye_W, Vec3::Zero()}, level, {})) << "no direction";
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    for (int axis = 0; axis < 3; ++axis) {
      PointerRay ray = rayThrough(Vec3::Zero());
      ray.direction_W[axis] = bad;
      EXPECT_FALSE(computePointerTarget(ray, level, {})) << bad << " in the direction";
      ray = rayThrough(Vec3::Zero());
      ray.eye_W[axis] = bad;
      EXPECT_FALSE(computePointerTarget(ray, level, {})) << bad << " at the eye";
    }
    const PointerPlane plane = makeLevelPlane(Vec3(0, 0, bad));
    EXPECT_FALSE(computePointerTarget(rayThrough(Vec3::Zero()), plane, {})) << bad << " as height";
  }
}

TEST(PointerPlane, WheelMovesAlongTheNormalInProportionToTheDistance) {
  const PointerPlane level = makeLevelPlane(Vec3::Zero());  // 0.5 m from the eye
  const auto up_W = computeWheelTarget(level, kEye_W, 1.0, {});
  ASSERT_TRUE(up_W);
  EXPECT_LT((*up_W - Vec3(0, 0, 0.004)).norm(), 1e-16);
  const auto down_W = computeWheelTarget(level, 2.0 * kEye_W, -2.5, {});
  ASSERT_TRUE(down_W);
  EXPECT_LT((*down_W - Vec3(0, 0, -0.020)).norm(), 1e-16);
  const auto away_W = computeWheelTarget(*makeUprightPlane(Vec3::Zero(), -kEye_W), kEye_W, 1.0, {});
  ASSERT_TRUE(away_W);
  EXPECT_LT((*away_W - Vec3(0, 0.004, 0)).norm(), 1e-16);
}

TEST(PointerPlane, WheelStaysInReach) {
  const PointerPlane level = makeLevelPlane(Vec3(0, 0, 0.399));
  EXPECT_FALSE(computeWheelTarget(level, kEye_W, 1.0, {}));
  EXPECT_TRUE(computeWheelTarget(level, kEye_W, -1.0, {}));
  EXPECT_FALSE(computeWheelTarget(level, kEye_W, std::numeric_limits<double>::quiet_NaN(), {}));
  EXPECT_FALSE(computeWheelTarget(level, kEye_W, std::numeric_limits<double>::infinity(), {}));
}

}  // namespace
}  // namespace tandem
