#include <algorithm>
#include <cmath>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "tandem/bullet_bridge/convert.h"

#include "native/native_coupling.h"

namespace tandem {

void setSoftContact(btCollisionObject& carrier, const CouplerGains& gains, int points) {
  const btScalar of_rigid_partner = btCollisionObject().getContactDamping();
  carrier.setContactStiffnessAndDamping(
      static_cast<btScalar>(gains.stiffness / points),
      static_cast<btScalar>(gains.damping / points) - of_rigid_partner);
}

Vec3 computeContactImpulse(btDiscreteDynamicsWorld& world, const btCollisionObject& body) noexcept {
  btVector3 sum(0, 0, 0);
  btDispatcher& dispatcher = *world.getDispatcher();
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    const bool is_first = manifold.getBody0() == &body;
    if (!is_first && manifold.getBody1() != &body) continue;
    // Contacts of ghosts are not solved: their points keep an old impulse.
    if (!manifold.getBody0()->hasContactResponse() || !manifold.getBody1()->hasContactResponse())
      continue;
    for (int p = 0; p < manifold.getNumContacts(); ++p) {
      const btManifoldPoint& point = manifold.getContactPoint(p);
      const btVector3 on_first = point.m_normalWorldOnB * point.m_appliedImpulse +
                                 point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
                                 point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2;
      sum += is_first ? on_first : -on_first;
    }
  }
  return fromBullet(sum);
}

double computeNativeOverlap(btDiscreteDynamicsWorld& world,
                            const btCollisionObject& body) noexcept {
  double deepest = 0.0;
  btDispatcher& dispatcher = *world.getDispatcher();
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    const bool is_first = manifold.getBody0() == &body;
    if (!is_first && manifold.getBody1() != &body) continue;
    if (!(is_first ? manifold.getBody1() : manifold.getBody0())->hasContactResponse()) continue;
    for (int p = 0; p < manifold.getNumContacts(); ++p)
      deepest = std::max(deepest, -static_cast<double>(manifold.getContactPoint(p).getDistance()));
  }
  return deepest;
}

void setNativeGhost(btCollisionObject& body, bool is_ghost) noexcept {
  constexpr int kGhost = btCollisionObject::CF_NO_CONTACT_RESPONSE;
  const int flags = body.getCollisionFlags();
  body.setCollisionFlags(is_ghost ? flags | kGhost : flags & ~kGhost);
}

void setNativeDamping(btRigidBody& body, double damping) {
  const double per_second = -std::expm1(-damping * static_cast<double>(body.getInvMass()));
  body.setDamping(static_cast<btScalar>(per_second), body.getAngularDamping());
}

}  // namespace tandem
