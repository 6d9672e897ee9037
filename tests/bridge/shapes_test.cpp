#include "tandem/bullet_bridge/shapes.h"

#include <optional>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btEmptyShape.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btMinkowskiSumShape.h>
#include <BulletCollision/CollisionShapes/btScaledBvhTriangleMeshShape.h>

#include "bridge/obstacle_scene.h"
#include "coordination/src/geometry/contact_geometry.h"
#include "coordination/src/geometry/triangle_mesh.h"
#include "support/random.h"
#include "support/solids.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::byWidth;

double gapAt(const Shape& shape, const Vec3& p) {
  return findSphereContact(p, 0.0, shape, Vec3::Zero(), Quat::Identity()).gap;
}

void fill(btConvexHullShape& hull, const std::vector<Vec3>& points) {
  for (const Vec3& p : points) hull.addPoint(toBullet(p));
}

void fill(btTriangleMesh& triangles, const std::vector<Vec3>& corners) {
  for (std::size_t i = 0; i < corners.size(); i += 3)
    triangles.addTriangle(toBullet(corners[i]), toBullet(corners[i + 1]), toBullet(corners[i + 2]));
}

// A hull is rounded by its margin, as Bullet collides it.
TEST(ConvertShape, RoundsAHullByItsMargin) {
  BulletRig rig;
  auto& hull = rig.makeShape<btConvexHullShape>();
  std::vector<Vec3> points = test::makeBoxSolid({0.25, 0.5, 0.125}).corners;
  points.emplace_back(0.1, 0.1, 0.1);    // inside
  points.emplace_back(0.25, 0.0, 0.0);   // on a face
  points.emplace_back(0.25, 0.5, 0.05);  // on an edge
  fill(hull, points);
  hull.setMargin(btScalar(0.0625));
  hull.setLocalScaling(btVector3(1, btScalar(0.5), 1));
  const auto shape = convertShape(hull);
  ASSERT_TRUE(shape);
  EXPECT_EQ(std::get<ConvexHull>(*shape).rounding, 0.0625);
  EXPECT_EQ(std::get<ConvexHull>(*shape).solid->vertices().size(), 8u);
  const double rounding = byWidth(1e-15, 1e-7);
  EXPECT_NEAR(gapAt(*shape, {0.0, 0.5, 0.0}), 0.25 - 0.0625, rounding);
  EXPECT_NEAR(gapAt(*shape, {0.25 + 0.3, 0.25 + 0.4, 0.0}), 0.5 - 0.0625, rounding);
  EXPECT_NEAR(gapAt(*shape, {0.0, 0.0, 0.0}), -0.125 - 0.0625, rounding);
}

TEST(ConvertShape, GivesAFlatHullSomeThickness) {
  BulletRig rig;
  auto& hull = rig.makeShape<btConvexHullShape>();
  fill(hull, {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, 1}});
  const double rounding = byWidth(1e-12, 1e-7);
  for (const double margin : {0.04, 0.0}) {
    hull.setMargin(static_cast<btScalar>(margin));
    const auto shape = convertShape(hull);
    ASSERT_TRUE(shape);
    for (const double side : {1.0, -1.0})
      EXPECT_NEAR(gapAt(*shape, {0.5, 0.5 * side, 0.5}), 0.5 - margin,
                  rounding + (margin > 0.0 ? 0.0 : 1.5e-4));
  }
  EXPECT_FALSE(convertShape(rig.makeShape<btConvexHullShape>()));
}

TEST(SampleShape, IsNotForWhatIsNotConvex) {
  BulletRig rig;
  EXPECT_FALSE(sampleShape(rig.makeShape<btCompoundShape>()));
  EXPECT_FALSE(sampleShape(rig.makeShape<btEmptyShape>()));
}

TEST(ConvertMesh, TakesMeshesAsTheyAreScaled) {
  BulletRig rig;
  btTriangleMesh triangles;
  fill(triangles, test::cutIntoTriangles(test::makeBoxSolid({0.5, 0.25, 0.25})));
  auto& mesh = rig.makeShape<btBvhTriangleMeshShape>(&triangles, true);
  mesh.setMargin(btScalar(0.03125));
  EXPECT_FALSE(convertShape(mesh));
  const auto own = convertMesh(mesh);
  ASSERT_TRUE(own);
  EXPECT_TRUE(std::get<Mesh>(*own).surface->isClosed());
  EXPECT_EQ(std::get<Mesh>(*own).surface->triangles().size(), 12u);
  const double rounding = byWidth(1e-15, 1e-7);
  EXPECT_NEAR(gapAt(*own, {0.75, 0.0, 0.0}), 0.25 - 0.03125, rounding);

  auto& scaled = rig.makeShape<btScaledBvhTriangleMeshShape>(&mesh, btVector3(1, 2, 1));
  const auto larger = convertMesh(scaled);
  ASSERT_TRUE(larger);
  EXPECT_NEAR(gapAt(*larger, {0.0, 0.75, 0.0}), 0.25 - static_cast<double>(scaled.getMargin()),
              rounding);
  EXPECT_FALSE(convertMesh(rig.makeShape<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0))));
  EXPECT_FALSE(convertMesh(rig.makeShape<btSphereShape>(btScalar(1))));
}

TEST(ConvertMesh, HeightFieldsAreFreeAbove) {
  constexpr int kPoints = 5;
  // Bullet reads heights in its own width.
  std::vector<btScalar> heights(kPoints * kPoints, 0);
  heights[12] = btScalar(0.5);  // the middle
  for (const int up : {1, 2}) {
    BulletRig rig;
    auto& field =
        rig.makeShape<btHeightfieldTerrainShape>(kPoints, kPoints, heights.data(), btScalar(1),
                                                 btScalar(-1), btScalar(1), up, PHY_FLOAT, false);
    field.setMargin(0);
    const auto own = convertMesh(field);
    ASSERT_TRUE(own);
    EXPECT_NEAR(gapAt(*own, Vec3::Unit(up)), 0.5, byWidth(1e-12, 1e-6)) << "up " << up;
    EXPECT_NEAR(gapAt(*own, -0.0625 * Vec3::Unit(up) + 1.6 * Vec3::Unit(0)), -0.0625,
                byWidth(1e-12, 1e-6));
  }
}

TEST(ShareableShape, AreAllThatTheIslandKnowsAndConvex) {
  BulletRig rig;
  auto& hull = rig.makeShape<btConvexHullShape>();
  fill(hull, test::makeOctahedron({0.02, 0.03, 0.02}).corners);
  EXPECT_TRUE(std::holds_alternative<ConvexHull>(getShareableShape(rig.addBody(hull, 0.1))));
  btCollisionShape& bar = rig.makeShape<btCylinderShape>(btVector3(1, 1, 1));
  EXPECT_TRUE(std::holds_alternative<Cylinder>(getShareableShape(rig.addBody(bar, 0.1))));
  EXPECT_THROW(
      static_cast<void>(getShareableShape(rig.addBody(rig.makeShape<btCompoundShape>(), 0.1))),
      Error);
  EXPECT_THROW(static_cast<void>(getShareableShape(rig.addBody(
                   rig.makeShape<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0)), 0))),
               Error);
}

TEST(NearSpheres, KeepsAMeshWhileItsObjectIsInTheWorld) {
  BulletRig rig;
  btTriangleMesh triangles;
  fill(triangles, test::makeFloor(4, 0.1));
  auto& mesh = rig.makeShape<btBvhTriangleMeshShape>(&triangles, true);
  btRigidBody& floor = rig.addBody(mesh, 0);
  Obstacles obstacles(rig.world);
  obstacles.addSphere(0, 0.01);
  const auto find = [&](double y) {
    RigidState state;
    state.p_W = Vec3(0.01, y, 0.01);
    obstacles.update({state}, 0.04);
    return obstacles.nearSpheres();
  };
  const auto first = find(0.03);
  ASSERT_EQ(first.size(), 1u);
  const auto* surface = std::get<Mesh>(first[0].shape).surface.get();
  EXPECT_TRUE(find(1.0).empty());
  EXPECT_EQ(std::get<Mesh>(find(0.03)[0].shape).surface.get(), surface);
  rig.world.removeRigidBody(&floor);
  EXPECT_TRUE(find(0.03).empty());
  rig.world.addRigidBody(&floor);
  EXPECT_NE(std::get<Mesh>(find(0.03)[0].shape).surface.get(), surface);
}

/// The form of the only fixed shape near a ball of 1 cm in the origin.
Shape findOnlyNear(Obstacles& obstacles) {
  obstacles.update({RigidState{}}, 0.04);
  EXPECT_EQ(obstacles.nearSpheres().size(), 1u);
  return obstacles.nearSpheres().at(0).shape;
}

btMultiSphereShape makePair(double radius) {
  const btVector3 places[] = {btVector3(btScalar(-0.01), 0, 0), btVector3(btScalar(0.01), 0, 0)};
  const btScalar radii[] = {btScalar(0.01), static_cast<btScalar>(radius)};
  return {places, radii, 2};
}

TEST(NearSpheres, KeepsASampledShapeUntilItIsScaled) {
  BulletRig rig;
  auto& pair = rig.makeShape<btMultiSphereShape>(makePair(0.02));
  rig.addBody(pair, 0);
  Obstacles obstacles(rig.world);
  obstacles.addSphere(0, 0.01);
  const Shape first = findOnlyNear(obstacles);
  EXPECT_EQ(std::get<ConvexHull>(findOnlyNear(obstacles)).solid, std::get<ConvexHull>(first).solid);
  pair.setLocalScaling(btVector3(2, 2, 2));
  const Shape scaled = findOnlyNear(obstacles);
  EXPECT_NEAR(gapAt(first, {0.1, 0, 0}), 0.1 - 0.03, 1e-5);
  EXPECT_NEAR(gapAt(scaled, {0.1, 0, 0}), 0.1 - 0.06, 1e-5);
}

// A Minkowski sum does not tell that its parts have moved; its bounds do.
TEST(NearSpheres, NoticesThatPartsOfASampledShapeMove) {
  BulletRig rig;
  auto& ball = rig.makeShape<btSphereShape>(btScalar(0.01));
  auto& cone = rig.makeShape<btConeShape>(btScalar(0.01), btScalar(0.02));
  cone.setMargin(btScalar(0.001));
  auto& sum = rig.makeShape<btMinkowskiSumShape>(&cone, &ball);
  rig.addBody(sum, 0);
  Obstacles obstacles(rig.world);
  obstacles.addSphere(0, 0.01);
  EXPECT_NEAR(gapAt(findOnlyNear(obstacles), {0, 0.1, 0}), 0.1 - 0.021, 1e-5);
  sum.setTransformA(toBullet(Vec3(0, 0.005, 0), Quat::Identity()));
  EXPECT_NEAR(gapAt(findOnlyNear(obstacles), {0, 0.1, 0}), 0.1 - 0.026, 1e-5);
}

// A new shape may come where a deleted one was.
TEST(NearSpheres, ForgetsADeletedSampledShape) {
  BulletRig rig;
  std::optional<btMultiSphereShape> place(makePair(0.02));
  btRigidBody body(0, nullptr, &*place);
  rig.world.addRigidBody(&body);
  Obstacles obstacles(rig.world);
  obstacles.addSphere(0, 0.01);
  EXPECT_NEAR(gapAt(findOnlyNear(obstacles), {0.1, 0, 0}), 0.1 - 0.03, 1e-5);
  rig.world.removeRigidBody(&body);
  place.emplace(makePair(0.03));
  rig.world.addRigidBody(&body);
  EXPECT_NEAR(gapAt(findOnlyNear(obstacles), {0.1, 0, 0}), 0.1 - 0.04, 1e-5);
  rig.world.removeRigidBody(&body);
  place.reset();
  obstacles.update({RigidState{}}, 0.04);
  EXPECT_TRUE(obstacles.nearSpheres().empty());
}

TEST(NearSpheres, TakesMeshesAndHullsOutOfCompounds) {
  BulletRig rig;
  btTriangleMesh triangles;
  fill(triangles, test::makeFloor(4, 0.1));
  auto& hull = rig.makeShape<btConvexHullShape>();
  fill(hull, test::makeOctahedron({0.02, 0.03, 0.02}).corners);
  auto& compound = rig.makeShape<btCompoundShape>();
  compound.addChildShape(toBullet(Vec3(0, -0.02, 0), Quat::Identity()),
                         &rig.makeShape<btBvhTriangleMeshShape>(&triangles, true));
  compound.addChildShape(toBullet(Vec3(0.05, 0, 0), Quat::Identity()), &hull);
  rig.addBody(compound, 0);
  Obstacles obstacles(rig.world);
  obstacles.addSphere(0, 0.01);
  obstacles.update({RigidState{}}, 0.04);
  const auto& found = obstacles.nearSpheres();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<Mesh>(found[0].shape));
  EXPECT_TRUE(std::holds_alternative<ConvexHull>(found[1].shape));
  EXPECT_NEAR(found[1].p_WB.x(), 0.05, byWidth(1e-15, 1e-8));
}

}  // namespace
}  // namespace tandem
