// A hull is made once for its points, whoever asks for it and however often.

#include "shapes/hull_cache.h"

#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btConvexHullShape.h>

#include "tandem/bullet_bridge/convert.h"
#include "tandem/bullet_bridge/shapes.h"

#include "coordination/src/geometry/convex_polyhedron.h"
#include "physics/neighbour_scene.h"
#include "support/random.h"

namespace tandem {
namespace {

std::vector<Vec3> makeBall(std::size_t count, std::uint64_t seed) {
  test::Random random(seed);
  std::vector<Vec3> points;
  while (points.size() < count) points.push_back(0.05 * random.direction());
  return points;
}

void setPoints(btConvexHullShape& shape, const std::vector<Vec3>& points) {
  for (const Vec3& p : points) shape.addPoint(toBullet(p), false);
  shape.recalcLocalAabb();
}

const ConvexPolyhedron* solidOf(const btCollisionShape& shape) {
  return std::get<ConvexHull>(*convertShape(shape)).solid.get();
}

TEST(HullCache, MakesEachSolidOnce) {
  HullCache cache;
  const auto points = makeBall(500, 1), others = makeBall(500, 2);
  const auto solid = cache.find(points);
  ASSERT_TRUE(solid);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(cache.find(points), solid);
  EXPECT_EQ(cache.countMade(), 1u);
  EXPECT_NE(cache.find(others), solid);
  EXPECT_EQ(cache.find(points), solid);
  EXPECT_EQ(cache.countMade(), 2u);
}

TEST(HullCache, SeesTheSmallestChangeOfAPoint) {
  HullCache cache;
  auto points = makeBall(500, 3);
  const auto solid = cache.find(points);
  points[499].z() = std::nextafter(points[499].z(), 1.0);
  EXPECT_NE(cache.find(points), solid);
  points.pop_back();
  EXPECT_EQ(cache.find(points)->vertices().size(), 499u);
  EXPECT_EQ(cache.countMade(), 3u);
}

TEST(HullCache, RemembersThatPointsHaveNoVolume) {
  HullCache cache;
  auto points = makeBall(100, 4);
  for (Vec3& p : points) p.x() = 0.0;
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(cache.find(points));
  EXPECT_EQ(cache.countMade(), 1u);
}

TEST(HullCache, IsBoundedAndDropsTheOldest) {
  HullCache cache;
  const std::size_t count = HullCache::kMostPoints / 5;
  std::vector<std::vector<Vec3>> balls;
  for (std::uint64_t seed = 10; seed < 16; ++seed) {
    balls.push_back(makeBall(64, seed));
    balls.back().resize(count, Vec3::Zero());  // most of them inside, to be quick
    EXPECT_TRUE(cache.find(balls.back()));
    EXPECT_TRUE(cache.find(balls.front()));
    EXPECT_LE(cache.countPoints(), HullCache::kMostPoints);
  }
  EXPECT_EQ(cache.countMade(), 6u);
  (void)cache.find(balls[1]);  // the one unused for longest
  EXPECT_EQ(cache.countMade(), 7u);
}

// A host deletes a shape, and the next one may get its address: the points decide.
TEST(HullCache, ShapeAtTheAddressOfAnotherIsItsOwn) {
  std::optional<btConvexHullShape> shape(std::in_place);
  setPoints(*shape, makeBall(400, 20));
  const btCollisionShape* address = &*shape;
  const auto* solid = solidOf(*shape);
  shape.emplace();
  setPoints(*shape, makeBall(400, 21));
  ASSERT_EQ(address, &*shape);
  EXPECT_NE(solidOf(*shape), solid);
}

TEST(HullCache, EqualShapesShareASolid) {
  btConvexHullShape one, other;
  setPoints(one, makeBall(4000, 30));
  setPoints(other, makeBall(4000, 30));
  const std::uint64_t made = HullCache::ofProcess().countMade();
  const auto* solid = solidOf(one);
  EXPECT_EQ(solidOf(other), solid);
  EXPECT_EQ(solidOf(one), solid);
  EXPECT_EQ(HullCache::ofProcess().countMade(), made + 1);
  one.setLocalScaling(btVector3(2, 2, 2));
  EXPECT_NE(solidOf(one), solid);
}

// Counts work, not time: bodies that come to the cube and go, again and again.
TEST(HullCache, NeighboursThatComeBackCostNothing) {
  test::NeighbourScene scene;
  btConvexHullShape shape;
  setPoints(shape, makeBall(1000, 31));
  for (int i = 0; i < 3; ++i) scene.rig.addBody(shape, 0.2, Vec3(1.0 + i, 0.0, 0.0));
  scene.start();
  const std::uint64_t made = HullCache::ofProcess().countMade();
  for (int turn = 0; turn < 4; ++turn) {
    for (int i = 1; i < scene.rig.world.getNumCollisionObjects(); ++i) {
      auto* body = btRigidBody::upcast(scene.rig.world.getCollisionObjectArray()[i]);
      if (body == scene.cube || !body) continue;
      body->activate(true);
      body->setWorldTransform(toBullet(Vec3(0.075, 0.0, 0.0), Quat::Identity()));
      scene.run(0.05);
      body->setWorldTransform(toBullet(Vec3(1.0 + i, 1.0, 0.0), Quat::Identity()));
      body->setLinearVelocity(btVector3(0, 0, 0));
      scene.run(0.05);
    }
  }
  EXPECT_GE(scene.site->counters().promoted, 4u);
  EXPECT_EQ(HullCache::ofProcess().countMade(), made + 1);
}

}  // namespace
}  // namespace tandem
