#include "world/world_access.h"

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "tandem/bullet_bridge/convert.h"

#include "world/world_lookup.h"

namespace tandem {

btRigidBody* findRigidBody(const btDiscreteDynamicsWorld& world, const void* body,
                           int& hint) noexcept {
  hint = findInWorld(world, static_cast<const btRigidBody*>(body), hint);
  return hint < 0 ? nullptr : btRigidBody::upcast(world.getCollisionObjectArray()[hint]);
}

bool isDynamic(const btRigidBody& body) noexcept {
  return !body.isStaticOrKinematicObject() && body.getInvMass() > 0;
}

RigidState readState(const btRigidBody& body) noexcept {
  return {fromBullet(body.getCenterOfMassPosition()), fromBullet(body.getOrientation()),
          fromBullet(body.getLinearVelocity()), fromBullet(body.getAngularVelocity())};
}

void putBody(btDiscreteDynamicsWorld& world, btRigidBody& body, const RigidState& state) noexcept {
  if (isDynamic(body)) {
    body.activate(true);
    body.setLinearVelocity(toBullet(state.v_W));
    body.setAngularVelocity(toBullet(state.w_W));
  }
  // Velocities first: this call copies them for the interpolation of the motion state.
  body.setCenterOfMassTransform(toBullet(state.p_W, state.q_WB));
  body.setInterpolationWorldTransform(body.getWorldTransform());
  world.updateSingleAabb(&body);
}

void pushBody(btRigidBody& body, const Vec3& dv_W, const Vec3& dw_W) noexcept {
  body.activate(true);
  body.setLinearVelocity(toBullet(Vec3(fromBullet(body.getLinearVelocity()) + dv_W)));
  body.setAngularVelocity(toBullet(Vec3(fromBullet(body.getAngularVelocity()) + dw_W)));
}

void applyForce(btRigidBody& body, const Vec3& f_W, const Vec3& t_W) noexcept {
  body.activate(true);
  body.applyCentralForce(toBullet(f_W));
  body.applyTorque(toBullet(t_W));
}

void setWorldGravity(btDiscreteDynamicsWorld& world, const Vec3& gravity_W) noexcept {
  world.setGravity(toBullet(gravity_W));
}

std::vector<WorldContact> findContacts(btDiscreteDynamicsWorld& world) {
  std::vector<WorldContact> contacts;
  const auto rate = 1.0 / static_cast<double>(world.getSolverInfo().m_timeStep);
  btDispatcher& dispatcher = *world.getDispatcher();
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
      const btManifoldPoint& point = manifold.getContactPoint(k);
      WorldContact contact;
      contact.a = btRigidBody::upcast(manifold.getBody0());
      contact.b = btRigidBody::upcast(manifold.getBody1());
      contact.p_a = fromBullet(point.getPositionWorldOnA());
      contact.p_b = fromBullet(point.getPositionWorldOnB());
      contact.n = fromBullet(point.m_normalWorldOnB);
      contact.distance = static_cast<double>(point.getDistance());
      contact.force = rate * static_cast<double>(point.m_appliedImpulse);
      contact.friction =
          rate * fromBullet(point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
                            point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2);
      contacts.push_back(contact);
    }
  }
  return contacts;
}

void stepWorld(btDiscreteDynamicsWorld& world, double dt, int max_substeps, double fixed_step) {
  world.stepSimulation(static_cast<btScalar>(dt), max_substeps, static_cast<btScalar>(fixed_step));
}

}  // namespace tandem
