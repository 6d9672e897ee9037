// From points to pixels and back, and how far a user may move the eye.

#include "gl/projection.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "gl/eye_motion.h"

namespace tandem::view {
namespace {

constexpr PictureSize kSize = {.width = 1280, .height = 800};
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Eye makeEye() { return {.target_W = Vec3(0.1, -0.2, 0.05), .distance = 0.7}; }

bool areEqual(const Eye& a, const Eye& b) {
  return a.target_W == b.target_W && a.distance == b.distance && a.azimuth == b.azimuth &&
         a.elevation == b.elevation && a.field_of_view == b.field_of_view;
}

TEST(Projection, ShowsTheTargetInTheMiddle) {
  const auto middle = projectPoint(makeEye(), kSize, makeEye().target_W);
  ASSERT_TRUE(middle);
  EXPECT_NEAR(middle->point.x, 640.0, 1e-9);
  EXPECT_NEAR(middle->point.y, 400.0, 1e-9);
  EXPECT_NEAR(middle->depth, 0.7, 1e-12);
}

// From -y the x axis is to the right and z is up.
TEST(Projection, HasRightAndUpAsOneSeesThem) {
  const Eye eye = {.azimuth = -0.5 * std::numbers::pi, .elevation = 0.0};
  const auto right = projectPoint(eye, kSize, Vec3(0.1, 0, 0));
  const auto up = projectPoint(eye, kSize, Vec3(0, 0, 0.1));
  ASSERT_TRUE(right && up);
  EXPECT_GT(right->point.x, 700.0);
  EXPECT_NEAR(right->point.y, 400.0, 1e-9);
  EXPECT_NEAR(up->point.x, 640.0, 1e-9);
  EXPECT_LT(up->point.y, 340.0);
}

TEST(Projection, RayThroughAPixelMeetsThePointSeenThere) {
  const Eye eye = makeEye();
  for (const Vec3& p_W : {Vec3(0.2, -0.1, 0.0), Vec3(-0.3, 0.4, 0.2), Vec3(0.1, -0.2, 0.3)}) {
    const auto seen = projectPoint(eye, kSize, p_W);
    ASSERT_TRUE(seen);
    const auto ray = computeRay(eye, kSize, seen->point);
    ASSERT_TRUE(ray);
    EXPECT_NEAR(ray->direction_W.norm(), 1.0, 1e-12);
    EXPECT_LT((p_W - ray->eye_W).cross(ray->direction_W).norm(), 1e-12);
    EXPECT_GT((p_W - ray->eye_W).dot(ray->direction_W), 0.0);
  }
}

// What the graphics card does with the matrices is what the probes and the mouse compute.
TEST(Projection, MatricesAgreeWithProjectedPoints) {
  const Eye eye = makeEye();
  const Vec3 p_W(0.2, -0.1, 0.1);
  const Eigen::Vector4d clip = computeWorldToClip(eye, kSize) * p_W.homogeneous();
  const auto seen = projectPoint(eye, kSize, p_W);
  ASSERT_TRUE(seen);
  EXPECT_NEAR(0.5 * (1.0 + clip.x() / clip.w()) * kSize.width, seen->point.x, 1e-9);
  EXPECT_NEAR(0.5 * (1.0 - clip.y() / clip.w()) * kSize.height, seen->point.y, 1e-9);
  EXPECT_NEAR(clip.w(), seen->depth, 1e-12);
  EXPECT_LT(std::abs(clip.z() / clip.w()), 1.0);
}

TEST(Projection, RefusesWhatItCannotShow) {
  const Eye eye = makeEye();
  EXPECT_FALSE(projectPoint(eye, kSize, computeEyePosition(eye)));
  EXPECT_FALSE(projectPoint(eye, kSize, computeEyePosition(eye) + computeEyeAxes(eye).back_W));
  EXPECT_FALSE(projectPoint(eye, kSize, Vec3(kNaN, 0, 0)));
  EXPECT_FALSE(projectPoint(eye, {}, eye.target_W));
  EXPECT_FALSE(computeRay(eye, {.width = 0, .height = 800}, {.x = 1, .y = 1}));
  EXPECT_FALSE(computeRay(eye, kSize, {.x = kNaN, .y = 1}));
  EXPECT_FALSE(computeRay(eye, kSize, {.x = 1, .y = kInfinity}));
  Eye broken = eye;
  broken.distance = kNaN;
  EXPECT_FALSE(computeRay(broken, kSize, {.x = 1, .y = 1}));
  EXPECT_FALSE(projectPoint(broken, kSize, eye.target_W));
}

TEST(EyeMotion, StopsShortOfThePoles) {
  EXPECT_DOUBLE_EQ(orbitEye(makeEye(), 0.0, 10.0).elevation, kSteepestEye);
  EXPECT_DOUBLE_EQ(orbitEye(makeEye(), 0.0, -10.0).elevation, -kSteepestEye);
  EXPECT_GT(computeEyeAxes(orbitEye(makeEye(), 0.0, 10.0)).up_W.z(), 0.0);
}

TEST(EyeMotion, TurnsAllTheWayRound) {
  Eye eye = makeEye();
  for (int i = 0; i < 100; ++i) eye = orbitEye(eye, 0.02 * std::numbers::pi, 0.0);
  EXPECT_NEAR(eye.azimuth, makeEye().azimuth, 1e-12);
  EXPECT_LE(std::abs(orbitEye(eye, 1000.0, 0.0).azimuth), std::numbers::pi);
}

TEST(EyeMotion, KeepsItsDistanceWithinLimits) {
  EXPECT_DOUBLE_EQ(zoomEye(makeEye(), 0.5).distance, 0.35);
  EXPECT_DOUBLE_EQ(zoomEye(makeEye(), 1e-9).distance, kNearestEye);
  EXPECT_DOUBLE_EQ(zoomEye(makeEye(), 1e9).distance, kFarthestEye);
}

TEST(EyeMotion, PansSoThatTheTargetFollowsThePointer) {
  const Eye moved = panEye(makeEye(), kSize, 100.0, 40.0);
  const auto old_target = projectPoint(moved, kSize, makeEye().target_W);
  ASSERT_TRUE(old_target);
  EXPECT_NEAR(old_target->point.x, 740.0, 1e-9);
  EXPECT_NEAR(old_target->point.y, 440.0, 1e-9);
  EXPECT_LE(panEye(makeEye(), kSize, 1e12, 0.0).target_W.cwiseAbs().maxCoeff(), kFarthestTarget);
}

TEST(EyeMotion, IsNotMovedByNumbersThatAreNotFinite) {
  const Eye eye = limitEye(makeEye());
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    EXPECT_TRUE(areEqual(orbitEye(eye, bad, 0.1), eye));
    EXPECT_TRUE(areEqual(orbitEye(eye, 0.1, bad), eye));
    EXPECT_TRUE(areEqual(panEye(eye, kSize, bad, 1.0), eye));
    EXPECT_TRUE(areEqual(panEye(eye, kSize, 1.0, bad), eye));
    EXPECT_TRUE(areEqual(zoomEye(eye, bad), eye));
  }
  EXPECT_TRUE(areEqual(zoomEye(eye, 0.0), eye));
  EXPECT_TRUE(areEqual(zoomEye(eye, -1.0), eye));
  EXPECT_TRUE(areEqual(panEye(eye, {}, 1.0, 1.0), eye));
}

TEST(EyeMotion, MendsAnEyeThatIsNotFinite) {
  const Eye broken = {.target_W = Vec3(kNaN, 1.0, kInfinity),
                      .distance = kNaN,
                      .azimuth = kInfinity,
                      .elevation = kNaN,
                      .field_of_view = kNaN};
  EXPECT_FALSE(isUsable(broken));
  EXPECT_TRUE(isUsable(limitEye(broken)));
  EXPECT_EQ(limitEye(broken).target_W, Vec3(0, 1, 0));
}

}  // namespace
}  // namespace tandem::view
