#include <vector>

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btScaledBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletCollision/CollisionShapes/btTriangleMesh.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>

#include "bullet_values.h"
#include "mesh_checks.h"

// Surfaces without an inside: each triangle is there from both sides.
namespace tandem::test {
namespace {

using view::makeShapeMesh;

/// A roof of two squares of 1 m^2 that meet at a right angle.
struct Roof {
  Roof() {
    const btVector3 ridge_a(0, 0, 0), ridge_b(0, 1, 0), right_a(1, 0, 0), right_b(1, 1, 0);
    const btVector3 down_a(0, 0, -1), down_b(0, 1, -1);
    triangles.addTriangle(ridge_a, right_a, right_b);
    triangles.addTriangle(ridge_a, right_b, ridge_b);
    triangles.addTriangle(ridge_a, down_b, down_a);
    triangles.addTriangle(ridge_a, ridge_b, down_b);
  }
  btTriangleMesh triangles;
};

TEST(OpenMesh, ATriangleMeshShowsBothSides) {
  Roof roof;
  const btBvhTriangleMeshShape shape(&roof.triangles, true);
  const ShapeMesh mesh = makeShapeMesh(shape);
  EXPECT_EQ(mesh.indices.size() / 3, 8U);
  EXPECT_NEAR(areaOfBothSides(mesh), 2.0, 1e-6);
  expectFillsBounds(mesh, shape, static_cast<double>(shape.getMargin()) + 1e-6);
}

TEST(OpenMesh, AScaledTriangleMeshIsScaled) {
  Roof roof;
  btBvhTriangleMeshShape shape(&roof.triangles, true);
  shape.setLocalScaling(btVector3(1, 3, 1));
  EXPECT_NEAR(areaOfBothSides(makeShapeMesh(shape)), 6.0, 1e-5);
}

TEST(OpenMesh, AScaledCopyOfATriangleMeshIsScaledAndMirrored) {
  Roof roof;
  btBvhTriangleMeshShape child(&roof.triangles, true);
  const btScaledBvhTriangleMeshShape shape(&child, btVector3(1, -3, 1));
  const ShapeMesh mesh = makeShapeMesh(shape);
  EXPECT_NEAR(areaOfBothSides(mesh), 6.0, 1e-5);
  EXPECT_NEAR(reachOf(mesh, -Vec3::UnitY()), 3.0, 1e-6);
}

TEST(OpenMesh, AGImpactMeshShowsBothSides) {
  Roof roof;
  btGImpactMeshShape shape(&roof.triangles);
  shape.setLocalScaling(btVector3(1, 2, 1));
  shape.updateBound();
  EXPECT_NEAR(areaOfBothSides(makeShapeMesh(shape)), 4.0, 1e-5);
}

TEST(OpenMesh, AHeightFieldShowsBothSides) {
  constexpr int kWidth = 4, kLength = 3;
  std::vector<float> heights(kWidth * kLength, 0.0F);
  heights[5] = 0.5F;
  for (int up = 0; up < 3; ++up) {
    btHeightfieldTerrainShape shape(kWidth, kLength, heights.data(), 0, btScalar(0.5), up, false);
    shape.setLocalScaling(vec(0.1, 0.2, 0.3));
    const ShapeMesh mesh = makeShapeMesh(shape);
    EXPECT_EQ(mesh.indices.size() / 3, 2U * 2U * (kWidth - 1) * (kLength - 1));
    EXPECT_GT(areaOfBothSides(mesh), 0.0);
    expectFillsBounds(mesh, shape, static_cast<double>(shape.getMargin()) + 1e-6);
  }
}

TEST(OpenMesh, APlaneIsASquareAboutItsNearestPoint) {
  const btVector3 normal = btVector3(1, 2, 3).normalized();
  const btStaticPlaneShape plane(normal, 3);
  const ShapeMesh mesh = makeShapeMesh(plane);
  EXPECT_NEAR(areaOfBothSides(mesh), 4.0, 1e-5);
  Vec3 middle = Vec3::Zero();
  for (const ShapeMesh::Vertex& vertex : mesh.vertices) middle += toVec3(vertex.p);
  EXPECT_LT((middle / 8 - 3 * toVec3(normal)).norm(), 1e-5);
  EXPECT_NEAR(reachOf(mesh, toVec3(normal)), 3.0, 1e-5);
}

}  // namespace
}  // namespace tandem::test
