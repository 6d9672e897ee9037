#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>

#include "bullet_values.h"
#include "mesh_checks.h"

namespace tandem::test {
namespace {

using view::makeShapeMesh;

constexpr double kBox = 8 * 0.1 * 0.2 * 0.3;  // volume of the child [m^3]

btTransform placeAt(const btVector3& p) {
  return btTransform(btQuaternion(btVector3(0, 0, 1), SIMD_HALF_PI), p);
}

TEST(CompoundMesh, ChildrenAreAtTheirPlaces) {
  btBoxShape box(vec(0.1, 0.2, 0.3));
  btCompoundShape compound;
  compound.addChildShape(placeAt({1, 0, 0}), &box);
  compound.addChildShape(placeAt({-1, 0, 0}), &box);
  const ShapeMesh mesh = makeShapeMesh(compound);
  expectSolid(mesh);
  expectVolume(mesh, 2 * kBox, 1e-5);
  EXPECT_NEAR(reachOf(mesh, Vec3::UnitX()), 1.2, 1e-6);
  EXPECT_NEAR(reachOf(mesh, Vec3::UnitY()), 0.1, 1e-6);
}

TEST(CompoundMesh, ACompoundInACompoundIsTurnedTwice) {
  btBoxShape box(vec(0.1, 0.2, 0.3));
  btCompoundShape inner, outer;
  inner.addChildShape(placeAt({1, 0, 0}), &box);
  outer.addChildShape(placeAt({0, 0, 2}), &inner);
  const ShapeMesh mesh = makeShapeMesh(outer);
  expectSolid(mesh);
  expectVolume(mesh, kBox, 1e-5);
  EXPECT_NEAR(reachOf(mesh, Vec3::UnitX()), 0.1, 1e-6);
  EXPECT_NEAR(reachOf(mesh, Vec3::UnitY()), 1.2, 1e-6);
  EXPECT_NEAR(reachOf(mesh, Vec3::UnitZ()), 2.3, 1e-6);
}

TEST(CompoundMesh, ScalingGoesToTheChildren) {
  btBoxShape box(vec(0.1, 0.2, 0.3));
  btCompoundShape compound;
  compound.addChildShape(btTransform(btQuaternion::getIdentity(), {1, 0, 0}), &box);
  compound.setLocalScaling(btVector3(2, 1, 1));
  const ShapeMesh mesh = makeShapeMesh(compound);
  expectVolume(mesh, 2 * kBox, 1e-5);
  EXPECT_NEAR(reachOf(mesh, Vec3::UnitX()), 2.2, 1e-6);
}

TEST(CompoundMesh, AnEmptyCompoundHasNone) {
  EXPECT_TRUE(makeShapeMesh(btCompoundShape()).indices.empty());
}

TEST(CompoundMesh, AGImpactCompoundShowsItsChildren) {
  btBoxShape box(vec(0.1, 0.2, 0.3));
  btGImpactCompoundShape compound;
  compound.addChildShape(placeAt({1, 0, 0}), &box);
  const ShapeMesh mesh = makeShapeMesh(compound);
  expectSolid(mesh);
  expectVolume(mesh, kBox, 1e-5);
  EXPECT_NEAR(reachOf(mesh, Vec3::UnitX()), 1.2, 1e-6);
}

}  // namespace
}  // namespace tandem::test
