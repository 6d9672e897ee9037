#include <memory>
#include <string>
#include <vector>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btMultiSphereShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include "mesh_checks.h"
#include "support/random.h"

namespace tandem::test {
namespace {

using view::makeShapeMesh;

constexpr std::uint64_t kSeed = 20240607;
constexpr int kKinds = 12;
// Part of a shape's size between it and its facets. A strip of 16 cuts off 1.9 % of the radius, and
// the pole-to-pole facets as much again; 400 directions leave less.
constexpr double kFacets = 0.04;

btScalar drawSize(Random& random) { return static_cast<btScalar>(random.logUniform(0.005, 0.5)); }

btVector3 drawPoint(Random& random, double half) {
  const Vec3 p = random.inCube(half);
  return {static_cast<btScalar>(p.x()), static_cast<btScalar>(p.y()), static_cast<btScalar>(p.z())};
}

btVector3 drawSizes(Random& random) {
  const btScalar x = drawSize(random), y = drawSize(random), z = drawSize(random);
  return {x, y, z};
}

/// Half sizes of a cylinder, with a round section across its axis.
btVector3 drawCylinder(Random& random, int axis) {
  const btScalar radius = drawSize(random);
  btVector3 half(radius, radius, radius);
  half[axis] = drawSize(random);
  return half;
}

std::unique_ptr<btConvexShape> drawHull(Random& random) {
  auto hull = std::make_unique<btConvexHullShape>();
  const double half = random.logUniform(0.005, 0.5);
  const int count = 5 + random.below(60);
  for (int i = 0; i < count; ++i) hull->addPoint(drawPoint(random, half));
  hull->setMargin(0);
  return hull;
}

std::unique_ptr<btConvexShape> drawMultiSphere(Random& random) {
  std::vector<btVector3> centres;
  std::vector<btScalar> radii;
  for (int i = 1 + random.below(4); i > 0; --i) {
    centres.push_back(drawPoint(random, 0.2));
    radii.push_back(static_cast<btScalar>(random.logUniform(0.05, 0.2)));
  }
  return std::make_unique<btMultiSphereShape>(centres.data(), radii.data(),
                                              static_cast<int>(radii.size()));
}

std::unique_ptr<btConvexShape> drawConvex(Random& random, int kind) {
  const btScalar radius = drawSize(random), height = drawSize(random);
  switch (kind) {
    case 0:
      return std::make_unique<btBoxShape>(drawSizes(random));
    case 1:
      return std::make_unique<btSphereShape>(radius);
    case 2:
      return std::make_unique<btCapsuleShapeX>(radius, height);
    case 3:
      return std::make_unique<btCapsuleShape>(radius, height);
    case 4:
      return std::make_unique<btCapsuleShapeZ>(radius, height);
    case 5:
      return std::make_unique<btCylinderShapeX>(drawCylinder(random, 0));
    case 6:
      return std::make_unique<btCylinderShape>(drawCylinder(random, 1));
    case 7:
      return std::make_unique<btCylinderShapeZ>(drawCylinder(random, 2));
    case 8:
      return std::make_unique<btConeShapeX>(radius, height);
    case 9:
      return std::make_unique<btConeShapeZ>(radius, height);
    case 10:
      return drawHull(random);
    default:
      return drawMultiSphere(random);
  }
}

/// Expects that the mesh reaches as far as the shape does, but for the facets.
void expectReaches(const ShapeMesh& mesh, const btConvexShape& shape, const Vec3& direction) {
  const btVector3 towards(static_cast<btScalar>(direction.x()),
                          static_cast<btScalar>(direction.y()),
                          static_cast<btScalar>(direction.z()));
  const double reach = toVec3(shape.localGetSupportingVertex(towards)).dot(direction);
  const double back = toVec3(shape.localGetSupportingVertex(-towards)).dot(direction);
  const double size = reach - back, rounding = 1e-5 * size;
  EXPECT_LE(reachOf(mesh, direction), reach + rounding);
  EXPECT_GE(reachOf(mesh, direction), reach - kFacets * size - rounding);
}

TEST(ShapeMeshProperty, AnyConvexShapeIsClosedAndReachesAsFarAsItCollides) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  Random random(kSeed);
  for (int i = 0; i < 50 * kKinds; ++i) {
    const auto shape = drawConvex(random, i % kKinds);
    SCOPED_TRACE("shape " + std::to_string(i) + ", a " + shape->getName());
    const ShapeMesh mesh = makeShapeMesh(*shape);
    expectSolid(mesh);
    EXPECT_GT(volumeOf(mesh), 0.0);
    for (int draw = 0; draw < 20; ++draw) expectReaches(mesh, *shape, random.direction());
    if (testing::Test::HasFailure()) return;
  }
}

btTransform drawPose(Random& random) {
  const Quat q = random.rotation();
  return btTransform(btQuaternion(static_cast<btScalar>(q.x()), static_cast<btScalar>(q.y()),
                                  static_cast<btScalar>(q.z()), static_cast<btScalar>(q.w())),
                     drawPoint(random, 0.5));
}

TEST(ShapeMeshProperty, ACompoundOfCompoundsHasTheVolumeOfItsParts) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  Random random(kSeed);
  for (int i = 0; i < 50; ++i) {
    SCOPED_TRACE("compound " + std::to_string(i));
    const auto a = drawConvex(random, random.below(kKinds));
    const auto b = drawConvex(random, random.below(kKinds));
    btCompoundShape inner, outer;
    inner.addChildShape(drawPose(random), a.get());
    outer.addChildShape(drawPose(random), b.get());
    outer.addChildShape(drawPose(random), &inner);
    const ShapeMesh mesh = makeShapeMesh(outer);
    expectSolid(mesh);
    const double parts = volumeOf(makeShapeMesh(*a)) + volumeOf(makeShapeMesh(*b));
    EXPECT_NEAR(volumeOf(mesh) / parts, 1.0, 1e-3);
    if (testing::Test::HasFailure()) return;
  }
}

}  // namespace
}  // namespace tandem::test
