#include <cmath>
#include <vector>

#include <BulletCollision/CollisionShapes/btBox2dShape.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btConvex2dShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btConvexPointCloudShape.h>
#include <BulletCollision/CollisionShapes/btConvexTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btMinkowskiSumShape.h>
#include <BulletCollision/CollisionShapes/btMultiSphereShape.h>
#include <BulletCollision/CollisionShapes/btTetrahedronShape.h>
#include <BulletCollision/CollisionShapes/btTriangleMesh.h>
#include <BulletCollision/CollisionShapes/btTriangleShape.h>

#include "bullet_values.h"
#include "mesh_checks.h"

// Shapes whose surface is a hull, of their points or of their furthest points.
namespace tandem::test {
namespace {

using view::makeShapeMesh;

constexpr double kPi = 3.14159265358979323846;
constexpr double kExact = 1e-5;  // rounding to float

// Corners of a box of 0.2 x 0.4 x 0.6 m, the middles of its sides and its centre.
std::vector<btVector3> boxPoints() {
  std::vector<btVector3> points;
  for (int i = 0; i < 27; ++i) {
    points.emplace_back(btScalar(0.1) * static_cast<btScalar>(i % 3 - 1),
                        btScalar(0.2) * static_cast<btScalar>(i / 3 % 3 - 1),
                        btScalar(0.3) * static_cast<btScalar>(i / 9 - 1));
  }
  return points;
}

btConvexHullShape makeHull(const std::vector<btVector3>& points) {
  return btConvexHullShape(points.front().m_floats, static_cast<int>(points.size()));
}

TEST(HullMesh, AHullHasTheVolumeOfItsPointsWithoutMargin) {
  const btConvexHullShape hull = makeHull(boxPoints());
  const ShapeMesh mesh = makeShapeMesh(hull);
  EXPECT_EQ(mesh.indices.size(), 36U);
  expectSolid(mesh);
  expectVolume(mesh, 0.048, kExact);
  expectFillsBounds(mesh, hull, 2 * 0.04 + 1e-6);  // Bullet's bounds have the margin twice
}

TEST(HullMesh, AMirroredHullIsNotInsideOut) {
  btConvexHullShape hull = makeHull(boxPoints());
  hull.setLocalScaling(btVector3(-1, 2, 1));
  const ShapeMesh mesh = makeShapeMesh(hull);
  expectSolid(mesh);
  expectVolume(mesh, 2 * 0.048, kExact);
}

TEST(HullMesh, CornersAreExact) {
  const btConvexHullShape hull = makeHull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, vec(0, 0, 0.123456)});
  EXPECT_EQ(reachOf(makeShapeMesh(hull), Vec3::UnitZ()),
            static_cast<double>(static_cast<float>(btScalar(0.123456))));
}

TEST(HullMesh, ACloudOfPointsHasTheVolumeOfItsHull) {
  std::vector<btVector3> points = boxPoints();
  const btConvexPointCloudShape cloud(points.data(), static_cast<int>(points.size()),
                                      vec(1, 1, 0.5));
  const ShapeMesh mesh = makeShapeMesh(cloud);
  expectSolid(mesh);
  expectVolume(mesh, 0.024, kExact);
}

TEST(HullMesh, AConvexTriangleMeshHasTheVolumeOfItsHull) {
  btTriangleMesh triangles;
  const btVector3 o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  triangles.addTriangle(o, y, x);
  triangles.addTriangle(x, y, z);
  btConvexTriangleMeshShape shape(&triangles);
  shape.setLocalScaling(btVector3(1, 1, 3));
  const ShapeMesh mesh = makeShapeMesh(shape);
  expectSolid(mesh);
  expectVolume(mesh, 0.5, kExact);
}

TEST(HullMesh, ASimplexOfFourPointsIsATetrahedron) {
  const btBU_Simplex1to4 simplex({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  const ShapeMesh mesh = makeShapeMesh(simplex);
  expectSolid(mesh);
  expectVolume(mesh, 1.0 / 6.0, kExact);
}

TEST(HullMesh, FlatShapesShowBothSides) {
  const btBU_Simplex1to4 simplex({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const btTriangleShape triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const btBox2dShape box(vec(0.5, 0.25, 0));
  for (const btCollisionShape* shape : {static_cast<const btCollisionShape*>(&simplex),
                                        static_cast<const btCollisionShape*>(&triangle),
                                        static_cast<const btCollisionShape*>(&box)}) {
    const ShapeMesh mesh = makeShapeMesh(*shape);
    EXPECT_NEAR(areaOfBothSides(mesh), 0.5, 1e-6) << shape->getName();
  }
}

TEST(HullMesh, PointsAndLinesHaveNoSurface) {
  const btBU_Simplex1to4 point({1, 2, 3}), line({0, 0, 0}, {1, 0, 0});
  EXPECT_TRUE(makeShapeMesh(point).indices.empty());
  EXPECT_TRUE(makeShapeMesh(line).indices.empty());
  EXPECT_TRUE(makeShapeMesh(btConvexHullShape()).indices.empty());
}

TEST(HullMesh, AConvex2dShapeIsDrawnAsItsChild) {
  btCylinderShapeZ child(vec(0.1, 0.1, 0.02));
  const btConvex2dShape shape(&child);
  EXPECT_EQ(volumeOf(makeShapeMesh(shape)), volumeOf(makeShapeMesh(child)));
}

TEST(HullMesh, AMultiSphereOfTwoIsACapsule) {
  const btVector3 centres[] = {vec(-0.05, 0, 0), vec(0.05, 0, 0)};
  const btScalar radii[] = {btScalar(0.05), btScalar(0.05)};
  const btMultiSphereShape shape(centres, radii, 2);
  const ShapeMesh mesh = makeShapeMesh(shape);
  expectSolid(mesh);
  expectVolume(mesh, kPi * 0.0025 * (0.1 + 4.0 / 3.0 * 0.05), 0.03);
  expectFillsBounds(mesh, shape, static_cast<double>(shape.getMargin()) + 1e-6);
}

TEST(HullMesh, AScaledMultiSphereIsScaled) {
  const btVector3 centre(0, 0, 0);
  const btScalar radius = btScalar(0.05);
  btMultiSphereShape shape(&centre, &radius, 1);
  shape.setMargin(btScalar(0.001));
  shape.setLocalScaling(btVector3(1, 2, 3));
  EXPECT_NEAR(reachOf(makeShapeMesh(shape), Vec3::UnitZ()),
              shape.localGetSupportingVertex(btVector3(0, 0, 1)).z(), 1e-7);
}

TEST(HullMesh, AMinkowskiSumOfBoxesIsABoxWithRoundEdges) {
  btBoxShape a(vec(0.1, 0.1, 0.1)), b(vec(0.2, 0.1, 0.05));
  const btMinkowskiSumShape sum(&a, &b);
  const ShapeMesh mesh = makeShapeMesh(sum);
  expectSolid(mesh);
  EXPECT_NEAR(reachOf(mesh, Vec3::UnitX()), 0.3, 1e-6);
  EXPECT_NEAR(reachOf(mesh, Vec3::UnitZ()), 0.15, 1e-6);
  expectVolume(mesh, 0.6 * 0.4 * 0.3, 0.03);
}

}  // namespace
}  // namespace tandem::test
