#pragma once

#include <cstdint>

#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>
#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "bodies/equal_bits.h"
#include "shapes/parts_look.h"

namespace tandem {

/// Properties of a host's body that the island reads once, when it takes the body. A difference
/// means that the host changed the body, or made another one at its address.
struct BodyLook {
  int broadphase_id = -1;  ///< new whenever the body is added to its world
  int flags = 0;           ///< btCollisionObject::CollisionFlags
  int group = 0, mask = 0;
  const btCollisionShape* shape = nullptr;
  std::uint64_t parts = 0;  ///< lookAtParts()
  btScalar inverse_mass = 0, margin = 0;
  btVector3 inverse_inertia{0, 0, 0}, scaling{1, 1, 1}, linear_factor{1, 1, 1},
      angular_factor{1, 1, 1};

  /// The body must be in its world.
  [[nodiscard]] static BodyLook at(const btRigidBody& body) noexcept {
    BodyLook look;
    if (const btBroadphaseProxy* proxy = body.getBroadphaseHandle()) {
      look.broadphase_id = proxy->m_uniqueId;
      look.group = proxy->m_collisionFilterGroup;
      look.mask = proxy->m_collisionFilterMask;
    }
    look.flags = body.getCollisionFlags();
    look.shape = body.getCollisionShape();
    look.parts = lookAtParts(*look.shape);
    look.margin = look.shape->getMargin();
    look.scaling = look.shape->getLocalScaling();
    look.inverse_mass = body.getInvMass();
    look.inverse_inertia = body.getInvInertiaDiagLocal();
    look.linear_factor = body.getLinearFactor();
    look.angular_factor = body.getAngularFactor();
    return look;
  }

  [[nodiscard]] bool operator==(const BodyLook& other) const noexcept {
    return broadphase_id == other.broadphase_id && flags == other.flags && group == other.group &&
           mask == other.mask && shape == other.shape && parts == other.parts &&
           inverse_mass == other.inverse_mass && margin == other.margin &&
           equalBits(inverse_inertia, other.inverse_inertia) && equalBits(scaling, other.scaling) &&
           equalBits(linear_factor, other.linear_factor) &&
           equalBits(angular_factor, other.angular_factor);
  }
};

/// True if forces may move the body, and it takes part in contact and simulation: the island may
/// hold it. The body must be in its world.
[[nodiscard]] inline bool isMovedByForces(const btRigidBody& body) noexcept {
  return !body.isStaticOrKinematicObject() && body.getInvMass() > 0 && body.hasContactResponse() &&
         body.getActivationState() != DISABLE_SIMULATION;
}

}  // namespace tandem
