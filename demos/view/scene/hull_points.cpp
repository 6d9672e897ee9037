#include <BulletCollision/CollisionShapes/btBox2dShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btConvexPointCloudShape.h>
#include <BulletCollision/CollisionShapes/btConvexTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btStridingMeshInterface.h>

#include "scene/hull_mesh.h"

namespace tandem::view {
namespace {

using Points = std::vector<btVector3>;

class PointCollector : public btInternalTriangleIndexCallback {
 public:
  void internalProcessTriangleIndex(btVector3* triangle, int /*part*/, int /*index*/) override {
    points.insert(points.end(), triangle, triangle + 3);
  }
  Points points;
};

/// Works for hulls and clouds of points. Negative scaling mirrors them, as Bullet does.
template <class Cloud>
Points scaledPoints(const Cloud& cloud) {
  Points points;
  for (int i = 0; i < cloud.getNumPoints(); ++i) points.push_back(cloud.getScaledPoint(i));
  return points;
}

Points meshPoints(const btConvexTriangleMeshShape& shape) {
  const btVector3 far(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
  PointCollector collector;
  shape.getMeshInterface()->InternalProcessAllTriangles(&collector, -far, far);
  return collector.points;
}

/// Corners of a triangle or of a simplex, which Bullet does not scale.
Points vertices(const btPolyhedralConvexShape& shape) {
  Points points(static_cast<std::size_t>(shape.getNumVertices()));
  for (int i = 0; i < shape.getNumVertices(); ++i) {
    shape.getVertex(i, points[static_cast<std::size_t>(i)]);
  }
  return points;
}

Points corners(const btBox2dShape& shape) {
  const btVector3 half = shape.getHalfExtentsWithMargin();
  return {{-half.x(), -half.y(), 0},
          {half.x(), -half.y(), 0},
          {half.x(), half.y(), 0},
          {-half.x(), half.y(), 0}};
}

}  // namespace

std::optional<Points> findHullPoints(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case CONVEX_HULL_SHAPE_PROXYTYPE:
      return scaledPoints(static_cast<const btConvexHullShape&>(shape));
    case CONVEX_POINT_CLOUD_SHAPE_PROXYTYPE:
      return scaledPoints(static_cast<const btConvexPointCloudShape&>(shape));
    case CONVEX_TRIANGLEMESH_SHAPE_PROXYTYPE:
      return meshPoints(static_cast<const btConvexTriangleMeshShape&>(shape));
    case TRIANGLE_SHAPE_PROXYTYPE:
    case TETRAHEDRAL_SHAPE_PROXYTYPE:
      return vertices(static_cast<const btPolyhedralConvexShape&>(shape));
    case BOX_2D_SHAPE_PROXYTYPE:
      return corners(static_cast<const btBox2dShape&>(shape));
    default:
      return std::nullopt;
  }
}

}  // namespace tandem::view
