// The island's forms of Bullet's shapes have the surface at which Bullet collides them.

#include <cmath>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "tandem/bullet_bridge/shapes.h"

#include "bridge/bullet_gap.h"
#include "bridge/standing_shapes.h"
#include "support/random.h"

namespace tandem::test {
namespace {

constexpr double kBall = 0.005;  // radius of the ball [m]

/// Error of the search of Bullet.
const double kSearchError = byWidth(0.0, 3e-5);  // [m]

/// Compares gaps and normals of balls around a shape, outside it and its margin.
void expectSameSurface(const btConvexShape& bullet, const Shape& own, double accuracy,
                       std::uint64_t seed) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = random.inCube(0.06);
    const SphereContact mine = findSphereContact(p, kBall, own, Vec3::Zero(), Quat::Identity());
    if (mine.gap < 1e-4) continue;
    const SphereContact theirs = findBulletContact(bullet, p, kBall);
    ++compared;
    ASSERT_NEAR(mine.gap, theirs.gap, accuracy + kSearchError) << p.transpose();
    // Surfaces nearer to each other than e differ in their direction to a point at a distance d by
    // the root of 2 e / d at most.
    const double turn = std::sqrt(2.0 * (accuracy + kSearchError) / (mine.gap + kBall));
    ASSERT_LT((mine.n_W - theirs.n_W).norm(), turn + byWidth(1e-6, 1e-3)) << p.transpose();
  }
  EXPECT_GT(compared, 500);
}

class BulletSurface : public ::testing::TestWithParam<StandingShape> {};

TEST_P(BulletSurface, IsThatOfTheIslandsForm) {
  BulletRig rig;
  StandingShapes shapes(rig);
  const auto& bullet = static_cast<const btConvexShape&>(GetParam().make(shapes));
  std::optional<Shape> own = convertShape(bullet);
  const bool is_sampled = GetParam().name == "UnequalSpheres" || GetParam().name == "MinkowskiSum";
  EXPECT_EQ(own.has_value(), !is_sampled);
  if (!own) own = sampleShape(bullet);
  ASSERT_TRUE(own);
  expectSameSurface(bullet, *own, GetParam().accuracy, 20261123);
}

INSTANTIATE_TEST_SUITE_P(Shapes, BulletSurface, ::testing::ValuesIn(listConvexShapes()),
                         [](const auto& shape) { return shape.param.name; });

TEST(BulletSurfaceOfCones, AlongAnyAxisWithAnyScalingAndMargin) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double margin : {0.0, 0.003}) {
      btConeShape cone(btScalar(0.02), btScalar(0.05));
      cone.setConeUpIndex(axis);
      cone.setMargin(static_cast<btScalar>(margin));
      cone.setLocalScaling(btVector3(btScalar(0.8), btScalar(1.2), btScalar(1.1)));
      const auto own = convertShape(cone);
      ASSERT_TRUE(own && std::holds_alternative<Cone>(*own));
      expectSameSurface(cone, *own, byWidth(1e-9, 0.0), 20261124);
    }
  }
}

}  // namespace
}  // namespace tandem::test
