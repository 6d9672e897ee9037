#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "bodies/collider_look.h"
#include "bodies/equal_bits.h"

namespace tandem {

/// Properties of a host's body that the island reads once, when it takes the body. A difference
/// means that the host changed the body, or made another one at its address.
struct BodyLook {
  ColliderLook collider;
  btScalar inverse_mass = 0;
  btVector3 inverse_inertia{0, 0, 0}, linear_factor{1, 1, 1}, angular_factor{1, 1, 1};

  /// The body must be in its world.
  [[nodiscard]] static BodyLook at(const btRigidBody& body) noexcept {
    BodyLook look{ColliderLook::at(body)};
    look.inverse_mass = body.getInvMass();
    look.inverse_inertia = body.getInvInertiaDiagLocal();
    look.linear_factor = body.getLinearFactor();
    look.angular_factor = body.getAngularFactor();
    return look;
  }

  [[nodiscard]] bool operator==(const BodyLook& other) const noexcept {
    return collider == other.collider && inverse_mass == other.inverse_mass &&
           equalBits(inverse_inertia, other.inverse_inertia) &&
           equalBits(linear_factor, other.linear_factor) &&
           equalBits(angular_factor, other.angular_factor);
  }
};

/// True for a static body: neither forces nor its host's motion states move it.
[[nodiscard]] inline bool isFixed(const btRigidBody& body) noexcept {
  return body.getInvMass() == 0 && !body.isKinematicObject();
}

/// True if forces may move the body, and it takes part in contact and simulation: the island may
/// hold it. The body must be in its world.
[[nodiscard]] inline bool isMovedByForces(const btRigidBody& body) noexcept {
  return !body.isStaticOrKinematicObject() && body.getInvMass() > 0 && body.hasContactResponse() &&
         body.getActivationState() != DISABLE_SIMULATION;
}

}  // namespace tandem
