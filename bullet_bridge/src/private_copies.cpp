#include "private_copies.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>

#include "tandem/bullet_bridge/convert.h"

namespace tandem {
namespace {

/// Bullet finds no contact of two boxes at any gap. Boxes that rest on each other open and close by
/// rounding, so their copies are larger by this, and distances are put right [m]. Far above the
/// way of an inner step at rest, g h^2 = 6e-7, far below what a corner's place matters by.
constexpr btScalar kBoxSkin = btScalar(5e-6);

std::unique_ptr<btCollisionShape> makeOwnShape(const btCollisionShape& shape) {
  if (shape.getShapeType() == STATIC_PLANE_PROXYTYPE) {
    const auto& plane = static_cast<const btStaticPlaneShape&>(shape);
    return std::make_unique<btStaticPlaneShape>(plane.getPlaneNormal(), btScalar(0));
  }
  if (shape.getShapeType() == BOX_SHAPE_PROXYTYPE) {
    const auto& box = static_cast<const btBoxShape&>(shape);
    const btVector3 skin(kBoxSkin, kBoxSkin, kBoxSkin);
    auto copy = std::make_unique<btBoxShape>(box.getHalfExtentsWithMargin() + skin);
    copy->setMargin(box.getMargin());
    return copy;
  }
  return nullptr;
}

}  // namespace

PrivateCopy::PrivateCopy(btCollisionObject& host_object, BodyIndex body)
    : original(&host_object),
      host_shape(host_object.getCollisionShape()),
      index(body),
      own_shape(makeOwnShape(*host_object.getCollisionShape())) {
  copySurface();
  if (host_shape->getShapeType() == STATIC_PLANE_PROXYTYPE)
    plane = static_cast<const btStaticPlaneShape*>(own_shape.get());
  if (host_shape->getShapeType() == BOX_SHAPE_PROXYTYPE) skin = kBoxSkin;
  // Bullet's objects share shapes by non-const pointer; nothing here changes them.
  object.setCollisionShape(own_shape ? own_shape.get() : host_object.getCollisionShape());
  place(btTransform::getIdentity());
}

void PrivateCopy::copySurface() {
  object.setFriction(original->getFriction());
  object.setRollingFriction(original->getRollingFriction());
  object.setSpinningFriction(original->getSpinningFriction());
  object.setRestitution(original->getRestitution());
  object.setUserPointer(original->getUserPointer());
  object.setUserIndex(original->getUserIndex());
  object.setUserIndex2(original->getUserIndex2());
  object.setUserIndex3(original->getUserIndex3());
}

bool PrivateCopy::placeAsOriginal(const Vec3& origin_W) {
  const btTransform& host_pose = original->getWorldTransform();
  Vec3 p = fromBullet(host_pose.getOrigin()) - origin_W;
  if (plane) {
    // A plane has no middle: its origin goes to its point nearest to ours, so that numbers stay
    // small.
    const auto& host_plane = static_cast<const btStaticPlaneShape&>(*original->getCollisionShape());
    const Vec3 normal = fromBullet(host_pose.getBasis() * host_plane.getPlaneNormal());
    p = (normal.dot(p) + static_cast<double>(host_plane.getPlaneConstant())) * normal;
  }
  const btTransform pose(host_pose.getBasis(), toBullet(p));
  const bool moved = !(pose == object.getWorldTransform());
  if (moved) place(pose);
  return moved;
}

void PrivateCopy::place(const btTransform& pose) {
  object.setWorldTransform(pose);
  bounds = computeRegion(*object.getCollisionShape(), pose);
}

}  // namespace tandem
