#include "tandem/bullet_bridge/shapes.h"

#include <stdexcept>
#include <utility>
#include <vector>

#include <BulletCollision/CollisionShapes/btBox2dShape.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btConvex2dShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btMultiSphereShape.h>
#include <BulletCollision/CollisionShapes/btPolyhedralConvexShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletCollision/CollisionShapes/btUniformScalingShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "tandem/bullet_bridge/convert.h"

#include "coordination/src/geometry/triangle_mesh.h"
#include "shapes/compound_form.h"
#include "shapes/convex_shapes.h"
#include "shapes/only_shape.h"
#include "shapes/thick_hull.h"

namespace tandem {
namespace {

Axis toAxis(int axis) { return axis == 0 ? Axis::kX : axis == 1 ? Axis::kY : Axis::kZ; }

/// Bullet's cylinders are round: of an oval one it takes the first radius.
Cylinder convertCylinder(const btCylinderShape& cylinder) {
  const Vec3 half = fromBullet(cylinder.getHalfExtentsWithMargin());
  const int axis = cylinder.getUpAxis();
  return {half[axis == 0 ? 1 : 0], half[axis], toAxis(axis)};
}

/// A flat box gets some thickness.
Box convertBox2d(const btBox2dShape& box) {
  const Vec3 half = fromBullet(box.getHalfExtentsWithMargin());
  return {half.cwiseMax(kThin * half.maxCoeff())};
}

/// A shape that others may enclose, which only scale it.
struct Bare {
  const btCollisionShape* shape;
  double factor = 1.0;
};

Bare unwrap(const btCollisionShape& whole) {
  Bare bare{&onlyShapeOf(whole)};
  for (;;) {
    if (bare.shape->getShapeType() == UNIFORM_SCALING_SHAPE_PROXYTYPE) {
      const auto& scaling = static_cast<const btUniformScalingShape&>(*bare.shape);
      bare.factor *= static_cast<double>(scaling.getUniformScalingFactor());
      bare.shape = scaling.getChildShape();
    } else if (bare.shape->getShapeType() == CONVEX_2D_SHAPE_PROXYTYPE) {
      bare.shape = static_cast<const btConvex2dShape&>(*bare.shape).getChildShape();
    } else {
      return bare;
    }
  }
}

std::optional<Shape> scaleAs(const Bare& bare, std::optional<Shape> shape) {
  return shape && bare.factor != 1.0 ? scaleShape(*shape, bare.factor) : shape;
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

std::optional<Shape> convertBare(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case SPHERE_SHAPE_PROXYTYPE:
      return Sphere{static_cast<const btSphereShape&>(shape).getRadius()};
    case BOX_SHAPE_PROXYTYPE:
      return Box{fromBullet(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin())};
    case BOX_2D_SHAPE_PROXYTYPE:
      return convertBox2d(static_cast<const btBox2dShape&>(shape));
    case CAPSULE_SHAPE_PROXYTYPE: {
      const auto& capsule = static_cast<const btCapsuleShape&>(shape);
      return Capsule{capsule.getRadius(), capsule.getHalfHeight(), toAxis(capsule.getUpAxis())};
    }
    case CYLINDER_SHAPE_PROXYTYPE:
      return convertCylinder(static_cast<const btCylinderShape&>(shape));
    case CONE_SHAPE_PROXYTYPE: {
      const auto& cone = static_cast<const btConeShape&>(shape);
      return Cone{cone.getRadius(), 0.5 * cone.getHeight(), toAxis(cone.getConeUpIndex()),
                  cone.getMargin()};
    }
    case MULTI_SPHERE_SHAPE_PROXYTYPE:
      return convertEqualSpheres(static_cast<const btMultiSphereShape&>(shape));
    case STATIC_PLANE_PROXYTYPE: {
      const auto& plane = static_cast<const btStaticPlaneShape&>(shape);
      return Plane{fromBullet(plane.getPlaneNormal()).normalized(), plane.getPlaneConstant()};
    }
    default:
      if (!shape.isPolyhedral()) return std::nullopt;
      return convertCorners(static_cast<const btPolyhedralConvexShape&>(shape));
  }
}

}  // namespace

std::optional<Shape> convertShape(const btCollisionShape& shape) {
  const Bare bare = unwrap(shape);
  if (!hasChildren(*bare.shape)) return scaleAs(bare, convertBare(*bare.shape));
  MovingForm form = makeMovingForm(*bare.shape, findForm);
  if (form.unknown) form.shape.reset();
  return std::move(form.shape);
}

std::optional<Shape> findForm(const btCollisionShape& shape) {
  std::optional<Shape> own = convertShape(shape);
  if (!own) own = sampleShape(shape);
  if (!own) own = convertMesh(shape);
  return own;
}

std::optional<Shape> sampleShape(const btCollisionShape& shape) {
  const Bare bare = unwrap(shape);
  if (!bare.shape->isConvex()) return std::nullopt;
  return scaleAs(bare, sampleConvex(static_cast<const btConvexShape&>(*bare.shape)));
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

std::optional<Shape> findShareableShape(const btRigidBody& body) {
  const btCollisionShape& shape = *body.getCollisionShape();
  if (!shape.isConvex() && !shape.isCompound()) return std::nullopt;
  std::optional<Shape> own = convertShape(shape);
  if (!own) own = sampleShape(shape);
  if (own && std::holds_alternative<Plane>(*own)) own.reset();
  return own;
}

Shape getShareableShape(const btRigidBody& body) {
  std::optional<Shape> own = findShareableShape(body);
  if (own) return *std::move(own);
  const btCollisionShape& shape = *body.getCollisionShape();
  const MovingForm form = makeMovingForm(shape, findForm);
  std::string name = shape.getName();
  if (hasChildren(shape))
    name += form.unknown ? std::string(" with a ") + form.unknown->getName() : " of nothing";
  throw Error(
      "a shared object must have a convex shape, or a compound of shapes that the hand can feel, "
      "not a " +
      name + "; give the body such a shape");
}

}  // namespace tandem
