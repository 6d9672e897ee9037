#include <cstddef>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btTriangleMesh.h>
#include <BulletCollision/CollisionShapes/btUniformScalingShape.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>

#include "bullet_values.h"
#include "scene/shape_mesh.h"

namespace tandem::test {
namespace {

using view::computeShapeKey;

/// Makes shapes one after the other at one address.
template <class Shape>
class Place {
 public:
  template <class... Arguments>
  std::uint64_t keyOf(Arguments&&... arguments) {
    Shape* const shape = new (memory_) Shape(std::forward<Arguments>(arguments)...);
    const std::uint64_t key = computeShapeKey(*shape);
    shape->~Shape();
    return key;
  }

 private:
  alignas(Shape) std::byte memory_[sizeof(Shape)];
};

TEST(ShapeKey, StaysWhileNothingChanges) {
  const btBoxShape box(vec(0.1, 0.2, 0.3));
  EXPECT_EQ(computeShapeKey(box), computeShapeKey(box));
}

TEST(ShapeKey, CountsTheAddress) {
  const btSphereShape a(btScalar(0.1)), b(btScalar(0.1));
  EXPECT_NE(computeShapeKey(a), computeShapeKey(b));
}

TEST(ShapeKey, CountsScalingAndMargin) {
  btBoxShape box(vec(0.1, 0.2, 0.3));
  const std::uint64_t key = computeShapeKey(box);
  box.setLocalScaling(btVector3(1, 1, 2));
  const std::uint64_t scaled = computeShapeKey(box);
  box.setMargin(btScalar(0.001));
  EXPECT_NE(key, scaled);
  EXPECT_NE(scaled, computeShapeKey(box));
}

TEST(ShapeKey, CountsSizesAtOneAddress) {
  Place<btBoxShape> boxes;
  EXPECT_EQ(boxes.keyOf(vec(0.1, 0.2, 0.3)), boxes.keyOf(vec(0.1, 0.2, 0.3)));
  EXPECT_NE(boxes.keyOf(vec(0.1, 0.2, 0.3)), boxes.keyOf(vec(0.1, 0.2, 0.31)));
  Place<btCapsuleShape> capsules;
  EXPECT_NE(capsules.keyOf(btScalar(0.1), btScalar(0.2)),
            capsules.keyOf(btScalar(0.2), btScalar(0.1)));
}

TEST(ShapeKey, CountsTheAxisOfACylinderAsLongAsWide) {
  alignas(btCylinderShape) std::byte memory[sizeof(btCylinderShape)];
  static_assert(sizeof(btCylinderShape) == sizeof(btCylinderShapeZ));
  const btVector3 half = vec(0.1, 0.1, 0.1);
  const auto* const along_y = new (memory) btCylinderShape(half);
  const std::uint64_t key = computeShapeKey(*along_y);
  along_y->~btCylinderShape();
  const auto* const along_z = new (memory) btCylinderShapeZ(half);
  EXPECT_NE(computeShapeKey(*along_z), key);
  along_z->~btCylinderShapeZ();
}

TEST(ShapeKey, CountsEachPointOfAHull) {
  std::vector<btVector3> points;
  for (int i = 0; i < 8; ++i) {
    points.emplace_back(static_cast<btScalar>(i & 1), static_cast<btScalar>(i / 2 & 1),
                        static_cast<btScalar>(i / 4));
  }
  points.push_back(vec(0.5, 0.25, 1.01));
  Place<btConvexHullShape> hulls;
  const std::uint64_t key = hulls.keyOf(points[0].m_floats, 9);
  points[8].setX(btScalar(0.501));
  EXPECT_NE(hulls.keyOf(points[0].m_floats, 9), key);
  EXPECT_NE(hulls.keyOf(points[0].m_floats, 8), key);
}

TEST(ShapeKey, CountsChildrenAndTheirPlaces) {
  btSphereShape sphere(btScalar(0.1));
  btCompoundShape inner, outer;
  inner.addChildShape(btTransform::getIdentity(), &sphere);
  outer.addChildShape(btTransform::getIdentity(), &inner);
  const std::uint64_t key = computeShapeKey(outer);
  sphere.setUnscaledRadius(btScalar(0.2));
  const std::uint64_t grown = computeShapeKey(outer);
  inner.updateChildTransform(0, btTransform(btQuaternion::getIdentity(), {1, 0, 0}));
  const std::uint64_t moved = computeShapeKey(outer);
  outer.addChildShape(btTransform::getIdentity(), &sphere);
  EXPECT_NE(key, grown);
  EXPECT_NE(grown, moved);
  EXPECT_NE(moved, computeShapeKey(outer));
}

TEST(ShapeKey, CountsTheChildOfAScaledShape) {
  btSphereShape sphere(btScalar(0.1));
  const btUniformScalingShape scaled(&sphere, 2);
  const std::uint64_t key = computeShapeKey(scaled);
  sphere.setUnscaledRadius(btScalar(0.2));
  EXPECT_NE(computeShapeKey(scaled), key);
}

TEST(ShapeKey, CountsTheTrianglesOfAMesh) {
  btTriangleMesh triangles;
  triangles.addTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  Place<btBvhTriangleMeshShape> meshes;
  const std::uint64_t key = meshes.keyOf(&triangles, true);
  EXPECT_EQ(meshes.keyOf(&triangles, true), key);
  triangles.addTriangle({0, 0, 0}, {1, 0, 0}, vec(0, 0.5, 0));
  EXPECT_NE(meshes.keyOf(&triangles, true), key);
}

TEST(ShapeKey, CountsTheScalingOfAGImpactMesh) {
  btTriangleMesh triangles;
  triangles.addTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  btGImpactMeshShape mesh(&triangles);
  mesh.updateBound();
  const std::uint64_t key = computeShapeKey(mesh);
  EXPECT_EQ(computeShapeKey(mesh), key);
  mesh.setLocalScaling(btVector3(2, 1, 1));
  mesh.updateBound();
  EXPECT_NE(computeShapeKey(mesh), key);
}

TEST(ShapeKey, CountsTheSizesOfAHeightField) {
  const std::vector<float> heights(12, 0.0F);
  Place<btHeightfieldTerrainShape> fields;
  const auto keyOf = [&](int width, int length, int up) {
    return fields.keyOf(width, length, heights.data(), btScalar(-1), btScalar(1), up, false);
  };
  EXPECT_EQ(keyOf(4, 3, 2), keyOf(4, 3, 2));
  EXPECT_NE(keyOf(4, 3, 2), keyOf(3, 4, 2));
  EXPECT_NE(keyOf(3, 3, 2), keyOf(3, 3, 1));
}

}  // namespace
}  // namespace tandem::test
