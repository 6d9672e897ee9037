#include "tandem/bullet_bridge/shapes.h"

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "tandem/bullet_bridge/convert.h"

#include "coordination/src/geometry/convex_polyhedron.h"
#include "coordination/src/geometry/triangle_mesh.h"
#include "shapes/only_shape.h"

namespace tandem {
namespace {

/// Half extents across a cylinder may differ by this share; more makes it oval.
constexpr double kRound = 1e-6;

Axis toAxis(int axis) { return axis == 0 ? Axis::kX : axis == 1 ? Axis::kY : Axis::kZ; }

std::optional<Shape> convertCylinder(const btCylinderShape& cylinder) {
  const Vec3 half = fromBullet(cylinder.getHalfExtentsWithMargin());
  const int axis = cylinder.getUpAxis();
  const double radius = half[(axis + 1) % 3];
  if (std::abs(half[(axis + 2) % 3] - radius) > kRound * radius) return std::nullopt;
  return Cylinder{radius, half[axis], toAxis(axis)};
}

std::optional<Shape> convertHull(const btConvexHullShape& hull) {
  std::vector<Vec3> points;
  for (int i = 0; i < hull.getNumPoints(); ++i)
    points.push_back(fromBullet(hull.getScaledPoint(i)));
  try {
    return ConvexHull{std::make_shared<const ConvexPolyhedron>(ConvexPolyhedron::makeHull(points)),
                      static_cast<double>(hull.getMargin())};
  } catch (const std::invalid_argument&) {
    return std::nullopt;  // a point, a line or a plate
  }
}

class TriangleReader final : public btTriangleCallback {
 public:
  void processTriangle(btVector3* corners, int, int) override {
    for (int i = 0; i < 3; ++i) corners_.push_back(fromBullet(corners[i]));
  }

  /// Flips all triangles if their free sides point down. The up axis is the one with the largest
  /// component of their summed area vectors.
  void turnUp() {
    Vec3 area = Vec3::Zero();
    for (std::size_t i = 0; i + 2 < corners_.size(); i += 3)
      area += (corners_[i + 1] - corners_[i]).cross(corners_[i + 2] - corners_[i]);
    int up = 0;
    area.cwiseAbs().maxCoeff(&up);
    if (area[up] >= 0.0) return;
    for (std::size_t i = 0; i + 2 < corners_.size(); i += 3)
      std::swap(corners_[i + 1], corners_[i + 2]);
  }
  [[nodiscard]] const std::vector<Vec3>& corners() const { return corners_; }

 private:
  std::vector<Vec3> corners_;
};

}  // namespace

std::optional<Shape> convertShape(const btCollisionShape& whole) {
  const btCollisionShape& shape = onlyShapeOf(whole);
  switch (shape.getShapeType()) {
    case SPHERE_SHAPE_PROXYTYPE:
      return Sphere{static_cast<const btSphereShape&>(shape).getRadius()};
    case BOX_SHAPE_PROXYTYPE:
      return Box{fromBullet(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin())};
    case CAPSULE_SHAPE_PROXYTYPE: {
      const auto& capsule = static_cast<const btCapsuleShape&>(shape);
      return Capsule{capsule.getRadius(), capsule.getHalfHeight(), toAxis(capsule.getUpAxis())};
    }
    case CYLINDER_SHAPE_PROXYTYPE:
      return convertCylinder(static_cast<const btCylinderShape&>(shape));
    case CONVEX_HULL_SHAPE_PROXYTYPE:
      return convertHull(static_cast<const btConvexHullShape&>(shape));
    case STATIC_PLANE_PROXYTYPE: {
      const auto& plane = static_cast<const btStaticPlaneShape&>(shape);
      return Plane{fromBullet(plane.getPlaneNormal()).normalized(), plane.getPlaneConstant()};
    }
    default:
      return std::nullopt;
  }
}

std::optional<Shape> convertMesh(const btCollisionShape& shape) {
  const int type = shape.getShapeType();
  if (!shape.isConcave() || type == STATIC_PLANE_PROXYTYPE || type == EMPTY_SHAPE_PROXYTYPE)
    return std::nullopt;
  btVector3 low, high;
  shape.getAabb(btTransform::getIdentity(), low, high);
  TriangleReader reader;
  static_cast<const btConcaveShape&>(shape).processAllTriangles(&reader, low, high);
  if (type == TERRAIN_SHAPE_PROXYTYPE) reader.turnUp();
  try {
    return Mesh{std::make_shared<const TriangleMesh>(reader.corners()),
                static_cast<double>(shape.getMargin())};
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

Shape getShareableShape(const btRigidBody& body) {
  const std::optional<Shape> shape = convertShape(*body.getCollisionShape());
  if (!shape || std::holds_alternative<Plane>(*shape))
    throw Error(
        std::string(
            "a shared object must be a box, sphere, capsule, cylinder or convex hull, not a ") +
        body.getCollisionShape()->getName() +
        "; give the body one of these shapes, or a compound of just one at its origin");
  return *shape;
}

}  // namespace tandem
