#include "bodies/mass_restore.h"

#include <cmath>
#include <limits>

namespace tandem {
namespace {

/// Switches off the linear and angular factors of a body for as long as it lives.
class WithoutFactors {
 public:
  explicit WithoutFactors(btRigidBody& body) noexcept
      : body_(body), linear_(body.getLinearFactor()), angular_(body.getAngularFactor()) {
    body_.setLinearFactor(btVector3(1, 1, 1));
    body_.setAngularFactor(btVector3(1, 1, 1));
  }
  ~WithoutFactors() {
    body_.setLinearFactor(linear_);
    body_.setAngularFactor(angular_);
  }
  WithoutFactors(const WithoutFactors&) = delete;
  WithoutFactors& operator=(const WithoutFactors&) = delete;

  void setTotals(const btVector3& force, const btVector3& torque) const noexcept {
    body_.clearForces();
    body_.applyCentralForce(force);
    body_.applyTorque(torque);
  }

 private:
  btRigidBody& body_;
  btVector3 linear_, angular_;
};

}  // namespace

btVector3 measureWeight(btRigidBody& body) noexcept {
  const btVector3 force = body.getTotalForce(), torque = body.getTotalTorque();
  const WithoutFactors without(body);
  body.clearForces();
  body.applyGravity();
  const btVector3 weight = body.getTotalForce();
  without.setTotals(force, torque);
  return weight;
}

WeightInStep::WeightInStep(btRigidBody& body) noexcept
    : weight_(measureWeight(body)),
      is_applied_(body.isActive() && !body.getTotalForce().isZero()) {}

void WeightInStep::follow(btRigidBody& body) const noexcept {
  const btVector3 now = measureWeight(body);
  if (!is_applied_ || now == weight_) return;
  const btVector3 factor = body.getLinearFactor(), torque = body.getTotalTorque();
  const btVector3 others = body.getTotalForce() - weight_ * factor;
  WithoutFactors(body).setTotals(others + now * factor, torque);
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
