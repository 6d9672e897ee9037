#include <algorithm>
#include <cmath>
#include <cstddef>

#include "tandem/bullet_bridge/convert.h"

#include "bench/guest/guest_arm.h"

// Motion of an arm, and its energy.

namespace tandem::demos::bench {
namespace {

constexpr int kSphericalRows = 3;

}  // namespace

std::vector<GuestArm::Motion> GuestArm::motions() const {
  const auto count = static_cast<std::size_t>(body_->getNumLinks()) + 1;
  std::vector<btVector3> omega(count), vel(count);
  body_->compTreeLinkVelocities(omega.data(), vel.data());
  std::vector<Motion> all;
  for (int i = -1; i < body_->getNumLinks(); ++i) {
    const auto at = static_cast<std::size_t>(i + 1);
    all.push_back({fromBullet(body_->localDirToWorld(i, vel[at])), fromBullet(omega[at])});
  }
  return all;
}

double GuestArm::energy(const Vec3& g_W) const {
  if (!world_ || !isFinite()) return 0.0;
  const std::vector<Motion> all = motions();
  double sum = 0.0;
  for (int i = body_->hasFixedBase() ? 0 : -1; i < body_->getNumLinks(); ++i) {
    const Motion& motion = all[static_cast<std::size_t>(i + 1)];
    const auto mass = static_cast<double>(i < 0 ? body_->getBaseMass() : body_->getLinkMass(i));
    const Vec3 inertia = fromBullet(i < 0 ? body_->getBaseInertia() : body_->getLinkInertia(i));
    const Vec3 p_W = fromBullet(body_->localPosToWorld(i, btVector3(0, 0, 0)));
    sum += 0.5 * mass * motion.v_W.squaredNorm() +
           0.5 * motion.w_B.dot(inertia.cwiseProduct(motion.w_B)) - mass * g_W.dot(p_W);
  }
  return sum;
}

double GuestArm::greatestRate() const {
  double rate = 0.0;
  for (int i = 0; i < body_->getNumLinks(); ++i)
    for (int k = 0; k < body_->getLink(i).m_dofCount; ++k)
      rate = std::max(rate, std::abs(static_cast<double>(body_->getJointVelMultiDof(i)[k])));
  return rate;
}

double GuestArm::mostWork(double dt) const {
  if (!world_) return 0.0;
  double power = torque_ * greatestRate() + force_ * speed();
  for (const Hold& hold : holds_) {
    const int type = hold.constraint->getConstraintType();
    const bool is_ball = type == MULTIBODY_CONSTRAINT_SPHERICAL_MOTOR;
    if (!is_ball && type != MULTIBODY_CONSTRAINT_1DOF_JOINT_MOTOR) continue;
    const btScalar* rates = body_->getJointVelMultiDof(hold.constraint->getLinkA());
    const double force = static_cast<double>(hold.constraint->getMaxAppliedImpulse()) / step_;
    for (int k = 0; k < (is_ball ? kSphericalRows : 1); ++k)
      power += force * std::abs(static_cast<double>(rates[k]));
  }
  return power * dt;
}

double GuestArm::speed() const {
  double most = 0.0;
  for (const Motion& motion : motions()) most = std::max(most, motion.v_W.norm());
  return most;
}

std::vector<Vec3> GuestArm::places() const {
  std::vector<Vec3> all;
  for (int i = body_->hasFixedBase() ? 0 : -1; i < body_->getNumLinks(); ++i)
    all.push_back(fromBullet(body_->localPosToWorld(i, btVector3(0, 0, 0))));
  return all;
}

bool GuestArm::isFinite() const {
  for (const Motion& motion : motions())
    if (!motion.v_W.allFinite() || !motion.w_B.allFinite()) return false;
  for (const Vec3& p_W : places())
    if (!p_W.allFinite()) return false;
  return true;
}

bool GuestArm::isAt(const GuestArm& other) const {
  const btMultiBody &a = *body_, &b = *other.body_;
  if (a.getBasePos() != b.getBasePos() || a.getBaseVel() != b.getBaseVel() ||
      a.getBaseOmega() != b.getBaseOmega() || a.getWorldToBaseRot() != b.getWorldToBaseRot())
    return false;
  for (int i = 0; i < a.getNumLinks(); ++i) {
    const btScalar *q = a.getLink(i).m_jointPos, *other_q = b.getLink(i).m_jointPos;
    if (!std::equal(q, q + a.getLink(i).m_posVarCount, other_q)) return false;
    const btScalar *u = a.getJointVelMultiDof(i), *other_u = b.getJointVelMultiDof(i);
    if (!std::equal(u, u + a.getLink(i).m_dofCount, other_u)) return false;
  }
  return true;
}

void GuestArm::takeMotion(const GuestArm& from) {
  const btMultiBody& other = *from.body_;
  body_->clearForcesAndTorques();
  body_->clearConstraintForces();
  body_->setBasePos(other.getBasePos());
  body_->setWorldToBaseRot(other.getWorldToBaseRot());
  body_->setBaseVel(other.getBaseVel());
  body_->setBaseOmega(other.getBaseOmega());
  for (int i = 0; i < body_->getNumLinks(); ++i) {
    body_->setJointPosMultiDof(i, other.getJointPosMultiDof(i));
    body_->setJointVelMultiDof(i, other.getJointVelMultiDof(i));
  }
  body_->wakeUp();
  for (const auto& collider : colliders_) {
    collider->forceActivationState(ACTIVE_TAG);
    collider->setDeactivationTime(0);
    collider->setHitFraction(1);
  }
  showPose();
}

}  // namespace tandem::demos::bench
