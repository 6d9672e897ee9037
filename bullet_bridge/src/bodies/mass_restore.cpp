#include "bodies/mass_restore.h"

#include <cmath>
#include <limits>

namespace tandem {

btVector3 measureWeight(btRigidBody& body) noexcept {
  const btVector3 force = body.getTotalForce();
  const btVector3 torque = body.getTotalTorque();
  const btVector3 linear_factor = body.getLinearFactor();
  const btVector3 angular_factor = body.getAngularFactor();
  body.setLinearFactor(btVector3(1, 1, 1));
  body.setAngularFactor(btVector3(1, 1, 1));
  body.clearForces();
  body.applyGravity();
  const btVector3 weight = body.getTotalForce();
  body.clearForces();
  body.applyCentralForce(force);
  body.applyTorque(torque);
  body.setLinearFactor(linear_factor);
  body.setAngularFactor(angular_factor);
  return weight;
}

void restoreMass(btRigidBody& body, btScalar inverse_mass, const btVector3& inverse_inertia,
                 const btVector3& weight) noexcept {
  // setMassProps() takes a mass and stores 1/mass and mass g. Rounding twice may not return x from
  // 1/x. A few neighbouring masses share one inverse but not one weight: try those nearby.
  constexpr int kNeighbours = 4;
  const btVector3 inertia = body.getLocalInertia();
  btScalar mass = btScalar(1) / inverse_mass;
  for (int i = 0; i < kNeighbours; ++i) mass = std::nextafter(mass, btScalar(0));
  btScalar fitting = btScalar(1) / inverse_mass;
  bool has_weight = false;
  for (int i = -kNeighbours; i <= kNeighbours && !has_weight; ++i) {
    if (btScalar(1) / mass == inverse_mass) {
      fitting = mass;
      has_weight = weight == mass * body.getGravity();
    }
    mass = std::nextafter(mass, std::numeric_limits<btScalar>::infinity());
  }
  body.setMassProps(fitting, inertia);
  // The host set its gravity after its mass, or changed it since.
  if (!has_weight) body.setGravity(body.getGravity());
  body.setInvInertiaDiagLocal(inverse_inertia);
  body.updateInertiaTensor();
}

}  // namespace tandem
