#include "tandem/bullet_bridge/shapes.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "tandem/bullet_bridge/convert.h"

namespace tandem {

std::optional<Shape> convertShape(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case SPHERE_SHAPE_PROXYTYPE:
      return Sphere{static_cast<const btSphereShape&>(shape).getRadius()};
    case BOX_SHAPE_PROXYTYPE:
      return Box{fromBullet(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin())};
    case CAPSULE_SHAPE_PROXYTYPE: {
      const auto& capsule = static_cast<const btCapsuleShape&>(shape);
      if (capsule.getUpAxis() != 1) return std::nullopt;
      return Capsule{capsule.getRadius(), capsule.getHalfHeight()};
    }
    case STATIC_PLANE_PROXYTYPE: {
      const auto& plane = static_cast<const btStaticPlaneShape&>(shape);
      return Plane{fromBullet(plane.getPlaneNormal()).normalized(), plane.getPlaneConstant()};
    }
    default:
      return std::nullopt;
  }
}

Shape getShareableShape(const btRigidBody& body) {
  const std::optional<Shape> shape = convertShape(*body.getCollisionShape());
  if (!shape || std::holds_alternative<Plane>(*shape))
    throw Error(
        std::string("a shared object must be a box, a sphere or a capsule along y, not a ") +
        body.getCollisionShape()->getName() + "; give the body one of these shapes");
  return *shape;
}

}  // namespace tandem
