// The sun's picture: it holds what casts shadows, and keeps still while bodies move.

#include "gl/shadow_frame.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace tandem::view {
namespace {

constexpr int kResolution = 1024;

Vec3 toClip(const ShadowFrame& frame, const Vec3& p_W) {
  return (frame.world_to_clip * p_W.homogeneous()).head<3>();
}

TEST(ShadowFrame, HoldsItsCasters) {
  const std::vector<BoundingBall> casters = {{.p_W = Vec3(0.1, 0.0, 0.1), .radius = 0.03},
                                             {.p_W = Vec3(-0.2, 0.1, 0.0), .radius = 0.05},
                                             {.p_W = Vec3(0.0, -0.1, 0.3), .radius = 0.01}};
  const ShadowFrame frame = computeShadowFrame(casters, Eye(), kResolution);
  for (const BoundingBall& ball : casters)
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {-1.0, 1.0}) {
        const Vec3 on_ball = ball.p_W + side * ball.radius * Vec3::Unit(axis);
        EXPECT_LE(toClip(frame, on_ball).cwiseAbs().maxCoeff(), 1.0);
      }
  EXPECT_NEAR(frame.texel, 0.5 / kResolution, 0.2 / kResolution);
}

TEST(ShadowFrame, IsDeepestAwayFromTheSun) {
  const ShadowFrame frame =
      computeShadowFrame({{.p_W = Vec3::Zero(), .radius = 0.1}}, Eye(), kResolution);
  EXPECT_LT(toClip(frame, 0.05 * sunDirection()).z(), toClip(frame, Vec3::Zero()).z());
}

// Shadows would creep along their edges if it moved by parts of a pixel.
TEST(ShadowFrame, MovesByWholePixels) {
  std::vector<BoundingBall> casters = {{.p_W = Vec3(0.1, 0.0, 0.1), .radius = 0.03},
                                       {.p_W = Vec3(-0.2, 0.1, 0.0), .radius = 0.05}};
  const ShadowFrame before = computeShadowFrame(casters, Eye(), kResolution);
  for (int i = 0; i < 20; ++i) {
    casters[0].p_W.x() += 0.00037;
    const ShadowFrame after = computeShadowFrame(casters, Eye(), kResolution);
    if (after.texel != before.texel) continue;
    const Vec3 shift =
        0.5 * kResolution * (toClip(after, Vec3::Zero()) - toClip(before, Vec3::Zero()));
    for (int axis = 0; axis < 2; ++axis) EXPECT_NEAR(shift[axis], std::round(shift[axis]), 1e-9);
  }
}

TEST(ShadowFrame, LeavesOutWhatIsFarFromTheTarget) {
  const std::vector<BoundingBall> casters = {{.p_W = Vec3::Zero(), .radius = 0.03},
                                             {.p_W = Vec3(8, 0, 0), .radius = 0.03}};
  EXPECT_LT(computeShadowFrame(casters, Eye(), kResolution).texel, 2.0 / kResolution);
}

TEST(ShadowFrame, IsFiniteWithoutCasters) {
  EXPECT_TRUE(computeShadowFrame({}, Eye(), kResolution).world_to_clip.allFinite());
}

}  // namespace
}  // namespace tandem::view
