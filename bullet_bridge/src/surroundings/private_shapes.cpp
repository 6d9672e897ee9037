#include "surroundings/private_shapes.h"

#include <vector>

#include <BulletCollision/CollisionShapes/btBox2dShape.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btConvex2dShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btConvexPointCloudShape.h>
#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <BulletCollision/CollisionShapes/btConvexTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btMinkowskiSumShape.h>
#include <BulletCollision/CollisionShapes/btMultiSphereShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletCollision/CollisionShapes/btStridingMeshInterface.h>
#include <BulletCollision/CollisionShapes/btTetrahedronShape.h>
#include <BulletCollision/CollisionShapes/btTriangleCallback.h>
#include <BulletCollision/CollisionShapes/btTriangleShape.h>
#include <BulletCollision/CollisionShapes/btUniformScalingShape.h>

namespace tandem {
namespace {

using ShapePointer = std::unique_ptr<btCollisionShape>;

/// Copies a shape that owns no memory, to the bit.
template <typename ShapeType>
ShapePointer copyPlainShape(const btCollisionShape& shape) {
  return std::make_unique<ShapeType>(static_cast<const ShapeType&>(shape));
}

/// Each axis has its own class.
ShapePointer copyAnyCylinder(const btCylinderShape& cylinder) {
  if (cylinder.getUpAxis() == 0) return copyPlainShape<btCylinderShapeX>(cylinder);
  if (cylinder.getUpAxis() == 2) return copyPlainShape<btCylinderShapeZ>(cylinder);
  return copyPlainShape<btCylinderShape>(cylinder);
}

/// Bullet rounds a cylinder's edges by its margin, within its size: leaning by 3 degrees, a peg of
/// 20 mm goes 0.05 mm into a wall. A fifth of the margin is as cheap and leaves enough for Bullet.
ShapePointer copyCylinder(const btCylinderShape& cylinder) {
  constexpr auto kSharpness = btScalar(0.2);
  ShapePointer copy = copyAnyCylinder(cylinder);
  copy->setMargin(kSharpness * cylinder.getMargin());
  return copy;
}

template <typename BoxType>
ShapePointer copyBox(const btCollisionShape& shape, btScalar skin) {
  const auto& box = static_cast<const BoxType&>(shape);
  auto copy =
      std::make_unique<BoxType>(box.getHalfExtentsWithMargin() + btVector3(skin, skin, skin));
  copy->setMargin(box.getMargin());
  return copy;
}

ShapePointer copyHull(const btConvexHullShape& hull) {
  const auto* points = static_cast<const btScalar*>(hull.getUnscaledPoints()[0]);
  auto copy = std::make_unique<btConvexHullShape>(points, hull.getNumPoints(), sizeof(btVector3));
  copy->setMargin(hull.getMargin());
  copy->setLocalScaling(hull.getLocalScaling());
  // To find the faces again would take seconds for a large hull.
  if (const btConvexPolyhedron* faces = hull.getConvexPolyhedron())
    copy->setPolyhedralFeatures(const_cast<btConvexPolyhedron&>(*faces));
  return copy;
}

/// A point cloud refers to the points of its maker.
class OwnPointCloud final : public btConvexPointCloudShape {
 public:
  explicit OwnPointCloud(const btConvexPointCloudShape& other) {
    auto& cloud = const_cast<btConvexPointCloudShape&>(other);
    own_.resize(other.getNumPoints());
    for (int i = 0; i < own_.size(); ++i) own_[i] = cloud.getUnscaledPoints()[i];
    if (own_.size() > 0) setPoints(&own_[0], own_.size(), true, other.getLocalScaling());
    setMargin(other.getMargin());
  }

 private:
  btAlignedObjectArray<btVector3> own_;
};

/// The corners of its triangles have the same farthest point in each direction.
ShapePointer copyConvexMesh(const btConvexTriangleMeshShape& shape) {
  struct Corners final : btInternalTriangleIndexCallback {
    btConvexHullShape* hull;
    void internalProcessTriangleIndex(btVector3* corners, int, int) override {
      for (int i = 0; i < 3; ++i) hull->addPoint(corners[i], false);
    }
  };
  auto copy = std::make_unique<btConvexHullShape>();
  Corners corners;
  corners.hull = copy.get();
  const btVector3 huge(btScalar(BT_LARGE_FLOAT), btScalar(BT_LARGE_FLOAT),
                       btScalar(BT_LARGE_FLOAT));
  // The mesh tells its corners scaled.
  shape.getMeshInterface()->InternalProcessAllTriangles(&corners, -huge, huge);
  copy->setMargin(shape.getMargin());
  copy->recalcLocalAabb();
  return copy;
}

ShapePointer copySpheres(const btMultiSphereShape& shape) {
  std::vector<btVector3> centres;
  std::vector<btScalar> radii;
  for (int i = 0; i < shape.getSphereCount(); ++i) {
    centres.push_back(shape.getSpherePosition(i));
    radii.push_back(shape.getSphereRadius(i));
  }
  auto copy = std::make_unique<btMultiSphereShape>(centres.data(), radii.data(),
                                                   static_cast<int>(radii.size()));
  copy->setMargin(shape.getMargin());
  copy->setLocalScaling(shape.getLocalScaling());
  return copy;
}

ShapePointer copyTriangle(const btTriangleShape& shape) {
  auto copy = std::make_unique<btTriangleShape>(shape.m_vertices1[0], shape.m_vertices1[1],
                                                shape.m_vertices1[2]);
  copy->setMargin(shape.getMargin());
  return copy;
}

ShapePointer copySimplex(const btBU_Simplex1to4& shape) {
  auto copy = std::make_unique<btBU_Simplex1to4>();
  for (int i = 0; i < shape.getNumVertices(); ++i) {
    btVector3 corner;
    shape.getVertex(i, corner);
    copy->addVertex(corner);
  }
  copy->setMargin(shape.getMargin());
  return copy;
}

/// A shape that shows others, with copies of these.
template <typename ShapeType>
class WithOwnChildren final : public ShapeType {
 public:
  template <typename... Arguments>
  explicit WithOwnChildren(ShapePointer first, ShapePointer second, Arguments... arguments)
      : ShapeType(arguments...), first_(std::move(first)), second_(std::move(second)) {}

 private:
  ShapePointer first_, second_;
};

ShapePointer copyFlat(const btConvex2dShape& shape) {
  ShapePointer child = copyShape(*shape.getChildShape());
  if (!child) return nullptr;
  auto* convex = static_cast<btConvexShape*>(child.get());
  return std::make_unique<WithOwnChildren<btConvex2dShape>>(std::move(child), nullptr, convex);
}

ShapePointer copyScaled(const btUniformScalingShape& shape) {
  ShapePointer child = copyShape(*shape.getChildShape());
  if (!child) return nullptr;
  auto* convex = static_cast<btConvexShape*>(child.get());
  return std::make_unique<WithOwnChildren<btUniformScalingShape>>(std::move(child), nullptr, convex,
                                                                  shape.getUniformScalingFactor());
}

ShapePointer copySum(const btMinkowskiSumShape& shape) {
  ShapePointer a = copyShape(*shape.getShapeA()), b = copyShape(*shape.getShapeB());
  if (!a || !b) return nullptr;
  auto* convex_a = static_cast<btConvexShape*>(a.get());
  auto* convex_b = static_cast<btConvexShape*>(b.get());
  auto copy = std::make_unique<WithOwnChildren<btMinkowskiSumShape>>(std::move(a), std::move(b),
                                                                     convex_a, convex_b);
  copy->setTransformA(shape.getTransformA());
  copy->setTransformB(shape.GetTransformB());
  return copy;
}

}  // namespace

std::unique_ptr<btCollisionShape> copyShape(const btCollisionShape& shape, btScalar skin) {
  switch (shape.getShapeType()) {
    case BOX_SHAPE_PROXYTYPE:
      return copyBox<btBoxShape>(shape, skin);
    case BOX_2D_SHAPE_PROXYTYPE:
      return copyBox<btBox2dShape>(shape, 0);
    case SPHERE_SHAPE_PROXYTYPE:
      return copyPlainShape<btSphereShape>(shape);
    case CAPSULE_SHAPE_PROXYTYPE:
      return copyPlainShape<btCapsuleShape>(shape);
    case CYLINDER_SHAPE_PROXYTYPE:
      return copyCylinder(static_cast<const btCylinderShape&>(shape));
    case CONE_SHAPE_PROXYTYPE:
      return copyPlainShape<btConeShape>(shape);
    case STATIC_PLANE_PROXYTYPE: {
      const auto& plane = static_cast<const btStaticPlaneShape&>(shape);
      return std::make_unique<btStaticPlaneShape>(plane.getPlaneNormal(), plane.getPlaneConstant());
    }
    case CONVEX_HULL_SHAPE_PROXYTYPE:
      return copyHull(static_cast<const btConvexHullShape&>(shape));
    case CONVEX_POINT_CLOUD_SHAPE_PROXYTYPE:
      return std::make_unique<OwnPointCloud>(static_cast<const btConvexPointCloudShape&>(shape));
    case CONVEX_TRIANGLEMESH_SHAPE_PROXYTYPE:
      return copyConvexMesh(static_cast<const btConvexTriangleMeshShape&>(shape));
    case MULTI_SPHERE_SHAPE_PROXYTYPE:
      return copySpheres(static_cast<const btMultiSphereShape&>(shape));
    case TRIANGLE_SHAPE_PROXYTYPE:
      return copyTriangle(static_cast<const btTriangleShape&>(shape));
    case TETRAHEDRAL_SHAPE_PROXYTYPE:
      return copySimplex(static_cast<const btBU_Simplex1to4&>(shape));
    case CONVEX_2D_SHAPE_PROXYTYPE:
      return copyFlat(static_cast<const btConvex2dShape&>(shape));
    case UNIFORM_SCALING_SHAPE_PROXYTYPE:
      return copyScaled(static_cast<const btUniformScalingShape&>(shape));
    case MINKOWSKI_DIFFERENCE_SHAPE_PROXYTYPE:
      return copySum(static_cast<const btMinkowskiSumShape&>(shape));
    default:
      return nullptr;
  }
}

std::unique_ptr<btCollisionShape> enlarge(btCollisionShape& own) {
  if (kEnlarged == btScalar(1) || !own.isConvex()) return nullptr;
  return std::make_unique<btUniformScalingShape>(static_cast<btConvexShape*>(&own), kEnlarged);
}

bool needsNearestPoints(const btCollisionShape& a, const btCollisionShape& b) noexcept {
  const auto isRound = [](const btCollisionShape& shape) {
    const int type = shape.getShapeType();
    return type == SPHERE_SHAPE_PROXYTYPE || type == CAPSULE_SHAPE_PROXYTYPE;
  };
  return !(a.isPolyhedral() && b.isPolyhedral()) && !(isRound(a) && isRound(b));
}

}  // namespace tandem
