#include "private_copies.h"

#include "tandem/bullet_bridge/convert.h"

namespace tandem {
namespace {

void copySurface(const btCollisionObject& original, btCollisionObject& copy) {
  copy.setFriction(original.getFriction());
  copy.setRollingFriction(original.getRollingFriction());
  copy.setSpinningFriction(original.getSpinningFriction());
  copy.setRestitution(original.getRestitution());
  // The setter switches the kind of anisotropy on unless the scale is (1, 1, 1).
  int mode = btCollisionObject::CF_ANISOTROPIC_FRICTION_DISABLED;
  for (const int kind : {btCollisionObject::CF_ANISOTROPIC_FRICTION,
                         btCollisionObject::CF_ANISOTROPIC_ROLLING_FRICTION}) {
    if (original.hasAnisotropicFriction(kind)) mode |= kind;
  }
  copy.setAnisotropicFriction(original.getAnisotropicFriction(), mode);
  copy.setUserPointer(original.getUserPointer());
  copy.setUserIndex(original.getUserIndex());
  copy.setUserIndex2(original.getUserIndex2());
  copy.setUserIndex3(original.getUserIndex3());
}

}  // namespace

std::unique_ptr<btRigidBody> copyBody(const btRigidBody& original) {
  // Bullet's bodies share shapes by non-const pointer; nothing here changes them.
  auto* shape = const_cast<btCollisionShape*>(original.getCollisionShape());
  auto copy =
      std::make_unique<btRigidBody>(original.getMass(), nullptr, shape, original.getLocalInertia());
  copySurface(original, *copy);
  copy->setFlags(0);
  copy->setLinearFactor(original.getLinearFactor());
  copy->setAngularFactor(original.getAngularFactor());
  return copy;
}

ObstacleCopy::ObstacleCopy(btCollisionObject& host_object)
    : original(&host_object), host_shape(host_object.getCollisionShape()) {
  copySurface(host_object, object);
  btCollisionShape* shape = host_object.getCollisionShape();
  if (shape->getShapeType() == STATIC_PLANE_PROXYTYPE) {
    const auto& host_plane = static_cast<const btStaticPlaneShape&>(*shape);
    plane = std::make_unique<btStaticPlaneShape>(host_plane.getPlaneNormal(), btScalar(0));
    shape = plane.get();
  }
  object.setCollisionShape(shape);
}

void ObstacleCopy::place(const Vec3& origin_W) {
  const btTransform& host_pose = original->getWorldTransform();
  Vec3 p = fromBullet(host_pose.getOrigin()) - origin_W;
  if (plane) {
    // A plane has no middle: its origin goes to its point nearest to ours, so that numbers stay
    // small.
    const auto& host_plane = static_cast<const btStaticPlaneShape&>(*original->getCollisionShape());
    const Vec3 normal = fromBullet(host_pose.getBasis() * host_plane.getPlaneNormal());
    p = (normal.dot(p) + static_cast<double>(host_plane.getPlaneConstant())) * normal;
  }
  object.setWorldTransform(btTransform(host_pose.getBasis(), toBullet(p)));
  bounds = computeRegion(*object.getCollisionShape(), object.getWorldTransform());
}

}  // namespace tandem
