#include "scene/shape_mesh.h"

#include <cmath>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btEmptyShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btUniformScalingShape.h>

#include "bullet_values.h"
#include "mesh_checks.h"

namespace tandem::test {
namespace {

using view::makeShapeMesh;

constexpr double kPi = 3.14159265358979323846;
constexpr double kCut = 0.064;   // part of a ball that 16 x 8 facets cut off: 0.063
constexpr double kChord = 0.02;  // part of a radius between a circle and its 16 chords: 0.0192
constexpr double kExact = 1e-5;  // rounding to float

/// Volume of a convex body that is grown by a margin: Steiner's formula.
double grownVolume(double volume, double area, double mean_curvature, double margin) {
  return volume + area * margin + mean_curvature * margin * margin +
         4.0 / 3.0 * kPi * std::pow(margin, 3);
}

double grownCylinder(double radius, double height, double margin) {
  return grownVolume(kPi * radius * radius * height, 2 * kPi * radius * (radius + height),
                     kPi * height + kPi * kPi * radius, margin);
}

double grownCone(double radius, double height, double margin) {
  return grownVolume(kPi * radius * radius * height / 3,
                     kPi * radius * (radius + std::hypot(radius, height)),
                     kPi * height + kPi * radius * (kPi - std::atan2(height, radius)), margin);
}

TEST(ShapeMesh, ABoxHasItsVolume) {
  const btBoxShape box(vec(0.02, 0.03, 0.05));
  const ShapeMesh mesh = makeShapeMesh(box);
  EXPECT_EQ(mesh.indices.size(), 36U);
  expectSolid(mesh);
  expectVolume(mesh, 0.04 * 0.06 * 0.10, kExact);
  expectFillsBounds(mesh, box, 0.0);
}

TEST(ShapeMesh, AMarginDoesNotChangeABox) {
  btBoxShape box(vec(0.02, 0.03, 0.05));
  box.setMargin(btScalar(0.001));
  expectVolume(makeShapeMesh(box), 0.04 * 0.06 * 0.10, kExact);
}

TEST(ShapeMesh, AScaledBoxHasItsVolume) {
  btBoxShape box(vec(0.02, 0.03, 0.05));
  box.setLocalScaling(vec(2, 3, 0.5));
  const ShapeMesh mesh = makeShapeMesh(box);
  expectVolume(mesh, 3.0 * 0.04 * 0.06 * 0.10, kExact);
  expectFillsBounds(mesh, box, 0.0);
}

TEST(ShapeMesh, ASphereHasItsVolume) {
  const btSphereShape sphere(btScalar(0.01));
  const ShapeMesh mesh = makeShapeMesh(sphere);
  EXPECT_EQ(mesh.indices.size() / 3, 16U * 2U * 7U);
  expectSolid(mesh);
  expectVolume(mesh, 4.0 / 3.0 * kPi * 1e-6, kCut);
  expectFillsBounds(mesh, sphere, 0.0);
}

TEST(ShapeMesh, ASphereHasTheNormalsOfTheTrueOne) {
  const ShapeMesh mesh = makeShapeMesh(btSphereShape(btScalar(0.5)));
  for (const ShapeMesh::Vertex& vertex : mesh.vertices) {
    EXPECT_LT((toVec3(vertex.p) - 0.5 * toVec3(vertex.n)).norm(), 1e-6);
  }
}

TEST(ShapeMesh, AScaledSphereTakesTheScaleOfX) {
  btSphereShape sphere(btScalar(0.01));
  sphere.setLocalScaling(btVector3(2, 1, 1));
  const ShapeMesh mesh = makeShapeMesh(sphere);
  expectVolume(mesh, 4.0 / 3.0 * kPi * 8e-6, kCut);
  expectFillsBounds(mesh, sphere, 0.0);
}

TEST(ShapeMesh, ACapsuleAlongAnyAxisHasItsVolume) {
  const btCapsuleShapeX x(btScalar(0.01), btScalar(0.05));
  const btCapsuleShape y(btScalar(0.01), btScalar(0.05));
  const btCapsuleShapeZ z(btScalar(0.01), btScalar(0.05));
  for (const btCapsuleShape* capsule :
       {static_cast<const btCapsuleShape*>(&x), &y, static_cast<const btCapsuleShape*>(&z)}) {
    const ShapeMesh mesh = makeShapeMesh(*capsule);
    expectSolid(mesh);
    expectVolume(mesh, kPi * 1e-4 * (0.05 + 4.0 / 3.0 * 0.01), kCut);
    expectFillsBounds(mesh, *capsule, 0.0);
  }
}

TEST(ShapeMesh, ACapsuleWithoutALengthIsASphere) {
  const ShapeMesh mesh = makeShapeMesh(btCapsuleShape(btScalar(0.01), 0));
  expectSolid(mesh);
  expectVolume(mesh, 4.0 / 3.0 * kPi * 1e-6, kCut);
}

TEST(ShapeMesh, ACylinderAlongAnyAxisHasItsVolume) {
  const btCylinderShapeX x(vec(0.04, 0.01, 0.01));
  const btCylinderShape y(vec(0.01, 0.04, 0.01));
  const btCylinderShapeZ z(vec(0.01, 0.01, 0.04));
  for (const btCylinderShape* cylinder :
       {static_cast<const btCylinderShape*>(&x), &y, static_cast<const btCylinderShape*>(&z)}) {
    const ShapeMesh mesh = makeShapeMesh(*cylinder);
    const auto margin = static_cast<double>(cylinder->getMargin());
    ASSERT_NEAR(margin, 0.001, 1e-8);
    expectSolid(mesh);
    expectVolume(mesh, grownCylinder(0.01 - margin, 0.08 - 2 * margin, margin), kCut);
    expectFillsBounds(mesh, *cylinder, 0.0);
  }
}

TEST(ShapeMesh, ACylinderWithoutAMarginHasSharpEdges) {
  btCylinderShapeZ cylinder(vec(0.01, 0.01, 0.04));
  cylinder.setMargin(0);
  const ShapeMesh mesh = makeShapeMesh(cylinder);
  EXPECT_EQ(mesh.indices.size() / 3, 64U);
  expectSolid(mesh);
  expectVolume(mesh, 8.0 * std::sin(kPi / 8) * 1e-4 * 0.08 * (1 + 1e-6), kExact);
}

TEST(ShapeMesh, AConeAlongAnyAxisIsGrownByItsMargin) {
  btConeShapeX x(btScalar(0.02), btScalar(0.05));
  btConeShape y(btScalar(0.02), btScalar(0.05));
  btConeShapeZ z(btScalar(0.02), btScalar(0.05));
  for (btConeShape* cone : {static_cast<btConeShape*>(&x), &y, static_cast<btConeShape*>(&z)}) {
    for (const double margin : {0.0, 0.002, 0.04}) {
      cone->setMargin(static_cast<btScalar>(margin));
      const ShapeMesh mesh = makeShapeMesh(*cone);
      expectSolid(mesh);
      expectVolume(mesh, grownCone(0.02, 0.05, margin), kCut);
      // Bullet adds the margin twice to a cone's bounds; a round rim's widest point is cut off.
      expectFillsBounds(mesh, *cone, margin + kChord * (0.02 + margin));
    }
  }
}

TEST(ShapeMesh, AConePointsUp) {
  btConeShapeZ cone(btScalar(0.02), btScalar(0.05));
  cone.setMargin(0);
  const ShapeMesh mesh = makeShapeMesh(cone);
  EXPECT_NEAR(reachOf(mesh, Vec3::UnitZ()), 0.025, 1e-8);
  EXPECT_NEAR(reachOf(mesh, Vec3(1, 0, 1).normalized()), 0.025 / std::sqrt(2.0), 1e-8);
  EXPECT_NEAR(reachOf(mesh, Vec3(1, 0, -1).normalized()), 0.045 / std::sqrt(2.0), 1e-8);
}

TEST(ShapeMesh, AScaledRoundShapeFillsItsBounds) {
  btCapsuleShapeX capsule(btScalar(0.01), btScalar(0.05));
  btCylinderShapeZ cylinder(vec(0.01, 0.01, 0.04));
  btConeShape cone(btScalar(0.02), btScalar(0.05));
  capsule.setLocalScaling(btVector3(2, 3, 3));
  cylinder.setLocalScaling(btVector3(3, 3, 2));
  cone.setLocalScaling(btVector3(3, 2, 3));
  expectFillsBounds(makeShapeMesh(capsule), capsule, 0.0);
  expectFillsBounds(makeShapeMesh(cylinder), cylinder, 0.0);
  const auto margin = static_cast<double>(cone.getMargin());
  expectFillsBounds(makeShapeMesh(cone), cone, margin + kChord * (0.06 + margin));
}

TEST(ShapeMesh, AUniformScalingShapeScalesItsChild) {
  btSphereShape sphere(btScalar(0.01));
  const btUniformScalingShape scaled(&sphere, 3);
  const ShapeMesh mesh = makeShapeMesh(scaled);
  expectSolid(mesh);
  expectVolume(mesh, 4.0 / 3.0 * kPi * 27e-6, kCut);
  EXPECT_NEAR(reachOf(mesh, Vec3::UnitX()), 0.03, 1e-8);
}

TEST(ShapeMesh, ASphereThatIsNotFiniteDoesNoHarm) {
  EXPECT_FALSE(makeShapeMesh(btSphereShape(btScalar(std::nan("")))).vertices.empty());
}

TEST(ShapeMesh, AnEmptyShapeHasNone) {
  const btEmptyShape empty;
  EXPECT_TRUE(makeShapeMesh(empty).vertices.empty());
  EXPECT_TRUE(makeShapeMesh(empty).indices.empty());
}

}  // namespace
}  // namespace tandem::test
