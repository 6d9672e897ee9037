#pragma once

#include <cstdint>

#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include "bodies/body_number.h"
#include "bodies/equal_bits.h"
#include "shapes/parts_look.h"

namespace tandem {

/// What a collision object is to contact, as the island reads it once.
struct ColliderLook {
  int number = -1;  ///< numberOf() a rigid body
  /// Most broadphases give another whenever an object is added. btAxisSweep3 and btSimpleBroadphase
  /// give it again.
  int broadphase_id = -1;
  int flags = 0;  ///< btCollisionObject::CollisionFlags
  int group = 0, mask = 0;
  const btCollisionShape* shape = nullptr;
  std::uint64_t parts = 0;  ///< lookAtParts()
  btScalar margin = 0;
  btVector3 scaling{1, 1, 1};

  /// The object must be in its world.
  [[nodiscard]] static ColliderLook at(const btCollisionObject& object) noexcept {
    ColliderLook look;
    if (const btRigidBody* body = btRigidBody::upcast(&object)) look.number = numberOf(*body);
    if (const btBroadphaseProxy* proxy = object.getBroadphaseHandle()) {
      look.broadphase_id = proxy->m_uniqueId;
      look.group = proxy->m_collisionFilterGroup;
      look.mask = proxy->m_collisionFilterMask;
    }
    look.flags = object.getCollisionFlags();
    look.shape = object.getCollisionShape();
    look.parts = lookAtParts(*look.shape);
    look.margin = look.shape->getMargin();
    look.scaling = look.shape->getLocalScaling();
    return look;
  }

  [[nodiscard]] bool operator==(const ColliderLook& other) const noexcept {
    return number == other.number && broadphase_id == other.broadphase_id && flags == other.flags &&
           group == other.group && mask == other.mask && shape == other.shape &&
           parts == other.parts && margin == other.margin && equalBits(scaling, other.scaling);
  }
};

/// True if the island can hold a moving object of this shape. Others stay Bullet's.
[[nodiscard]] inline bool hasPlainShape(const btCollisionObject& object) noexcept {
  const btCollisionShape& shape = *object.getCollisionShape();
  return shape.isConvex() || shape.isCompound();
}

/// True if the island knows all laws of the object's contact. Others stay Bullet's.
[[nodiscard]] inline bool hasPlainSurface(const btCollisionObject& object) noexcept {
  return !object.hasAnisotropicFriction(btCollisionObject::CF_ANISOTROPIC_FRICTION |
                                        btCollisionObject::CF_ANISOTROPIC_ROLLING_FRICTION) &&
         (object.getCollisionFlags() & btCollisionObject::CF_HAS_CONTACT_STIFFNESS_DAMPING) == 0;
}

}  // namespace tandem
