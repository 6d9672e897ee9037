#include "tandem/bullet_bridge/haptic_body.h"

#include <cmath>
#include <sstream>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include "tandem/bullet_bridge/convert.h"

#include "attach_warnings.h"
#include "mass_restore.h"
#include "rotation_vector.h"
#include "world_lookup.h"

// One step of the host in hand-off mode, x over time:
//
//   pre-tick            Bullet's step                post-tick
//   x0 known     ─► v_avg = (end - x0) / dt ─►   pose and velocity := end
//
// Bullet adds its accumulated forces to the velocity we give it before it moves the body, so they
// are taken off beforehand. What its velocity differs by afterwards came from its solver: contact
// with neighbours.

namespace tandem {
namespace {

constexpr int kGyroscopicFlags = BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT |
                                 BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD |
                                 BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY;

bool equalBits(const btVector3& a, const btVector3& b) {
  return a.x() == b.x() && a.y() == b.y() && a.z() == b.z();
}

bool equalBits(const btTransform& a, const btTransform& b) {
  const btMatrix3x3 &m = a.getBasis(), &n = b.getBasis();
  return equalBits(a.getOrigin(), b.getOrigin()) && equalBits(m[0], n[0]) &&
         equalBits(m[1], n[1]) && equalBits(m[2], n[2]);
}

bool isFinite(const HostChange& change) {
  return change.f_W.allFinite() && change.t_W.allFinite() && change.impulse_W.allFinite() &&
         change.angular_impulse_W.allFinite() && change.offset_W.allFinite() &&
         change.rotation_W.coeffs().allFinite();
}

void checkAttachable(const btDiscreteDynamicsWorld& world, const btRigidBody& body,
                     double mass_share) {
  std::ostringstream message;
  if (findInWorld(world, &body) < 0) {
    message << "the body is not in this Bullet world; call addRigidBody() before attaching it";
  } else if (body.isStaticOrKinematicObject()) {
    message << "the body is " << (body.isStaticObject() ? "static" : "kinematic")
            << "; only a dynamic body can be moved by forces: give it a mass and clear that "
               "collision flag";
  } else if (!(body.getInvMass() > 0)) {
    message << "the body has no mass; set one with setMassProps()";
  } else if (!(mass_share > 0.0 && mass_share <= 1.0)) {
    message << "mass share " << mass_share << " is not in (0, 1]; use 1/N for an object of N peers";
  } else {
    return;
  }
  throw Error(message.str());
}

}  // namespace

HapticBody::HapticBody(btDiscreteDynamicsWorld& world, btRigidBody& body, double mass_share)
    : world_(world), body_(body), world_index_(findInWorld(world, &body)) {
  checkAttachable(world, body, mass_share);
  original_ = {body.getInvMass(),          body.getInvInertiaDiagLocal(), measureWeight(body),
               body.getLinearDamping(),    body.getAngularDamping(),      body.getActivationState(),
               body.getDeactivationTime(), body.getWorldTransform()};
  body.setDamping(0, 0);
  has_additional_damping_ = hasAdditionalDamping(body);
  warnings_ = describeSurprises(body, original_.linear_damping, original_.angular_damping,
                                has_additional_damping_);
  body.forceActivationState(DISABLE_DEACTIVATION);
  if (mass_share != 1.0) scaleMass(mass_share);
  // Weight computed in one known way, so that takeHostChanges() can tell it from the host's forces
  // to the bit.
  body.setGravity(body.getGravity());
  remember();
}

HapticBody::~HapticBody() {
  if (!isInWorld()) return;
  if (handed_.pending) body_.setFlags(handed_.flags);
  restoreMass(body_, original_.inverse_mass, original_.inverse_inertia, original_.weight);
  body_.setDamping(original_.linear_damping, original_.angular_damping);
  restoreActivation();
}

void HapticBody::scaleMass(double share) {
  const auto factor = static_cast<btScalar>(share);
  body_.setMassProps(body_.getMass() * factor, body_.getLocalInertia() * factor);
  body_.updateInertiaTensor();
}

void HapticBody::restoreActivation() {
  const bool slept = original_.activation_state == ISLAND_SLEEPING ||
                     original_.activation_state == WANTS_DEACTIVATION;
  const bool untouched = equalBits(body_.getWorldTransform(), original_.pose);
  // A body put back to sleep in mid-air would hang there.
  body_.forceActivationState(slept && !untouched ? ACTIVE_TAG : original_.activation_state);
  body_.setDeactivationTime(slept && !untouched ? 0 : original_.deactivation_time);
}

bool HapticBody::isInWorld() const noexcept {
  world_index_ = findInWorld(world_, &body_, world_index_);
  return world_index_ >= 0;
}

double HapticBody::mass() const noexcept { return 1.0 / static_cast<double>(body_.getInvMass()); }

Vec3 HapticBody::inertia() const noexcept { return fromBullet(body_.getLocalInertia()); }

Vec3 HapticBody::gravityForce() const noexcept {
  return fromBullet(body_.getGravity() * (btScalar(1) / body_.getInvMass()) *
                    body_.getLinearFactor());
}

RigidState HapticBody::state() const noexcept {
  return {fromBullet(body_.getCenterOfMassPosition()), fromBullet(body_.getOrientation()),
          fromBullet(body_.getLinearVelocity()), fromBullet(body_.getAngularVelocity())};
}

Vec3 HapticBody::computeAngularMomentum(const Quat& q_WB, const Vec3& w_W) const noexcept {
  const Vec3 w_B = q_WB.conjugate() * w_W;
  return q_WB * inertia().cwiseProduct(w_B);
}

HostChange HapticBody::takeHostChanges(double dt) noexcept {
  HostChange change;
  if (!isInWorld()) return change;
  const RigidState now = state();
  change.f_W = fromBullet(body_.getTotalForce()) - gravityForce();
  change.t_W = fromBullet(body_.getTotalTorque());
  change.impulse_W = change.f_W * dt + (now.v_W - fromBullet(known_v_)) * mass();
  change.angular_impulse_W =
      change.t_W * dt + computeAngularMomentum(now.q_WB, now.w_W - fromBullet(known_w_));
  if (!equalBits(body_.getWorldTransform(), known_pose_)) {
    change.moved = true;
    change.offset_W = now.p_W - fromBullet(known_pose_.getOrigin());
    change.rotation_W = now.q_WB * fromBullet(known_pose_.getRotation()).conjugate();
  }
  remember();
  return isFinite(change) ? change : HostChange{};
}

void HapticBody::handOff(const RigidState& end, double dt) noexcept {
  if (!isInWorld() || !(dt > 0.0)) return;
  const RigidState start = state();
  if (!handed_.pending) handed_.flags = body_.getFlags();
  handed_.end = end;
  handed_.q_WB_start = start.q_WB;
  handed_.pending = true;
  body_.setFlags(handed_.flags & ~kGyroscopicFlags);

  // In Bullet's own arithmetic, so that a free body comes out without a trace of an impulse.
  const auto step = static_cast<btScalar>(dt);
  const btVector3 by_force = body_.getTotalForce() * body_.getInvMass() * step;
  const btVector3 by_torque = body_.getTotalTorque() * body_.getInvInertiaTensorWorld() * step;
  const btVector3 v = toBullet(Vec3((end.p_W - start.p_W) / dt)) - by_force;
  const btVector3 w = toBullet(Vec3(computeRotationVector(start.q_WB, end.q_WB) / dt)) - by_torque;
  body_.setLinearVelocity(v);
  body_.setAngularVelocity(w);
  if (has_additional_damping_) body_.applyDamping(step);
  handed_.expected_v = body_.getLinearVelocity() + by_force;
  handed_.expected_w = body_.getAngularVelocity() + by_torque;
  body_.setLinearVelocity(v);
  body_.setAngularVelocity(w);
}

HostChange HapticBody::restore() noexcept {
  HostChange change;
  if (!handed_.pending || !isInWorld()) return change;
  handed_.pending = false;
  body_.setFlags(handed_.flags);
  change.impulse_W = fromBullet(body_.getLinearVelocity() - handed_.expected_v) * mass();
  change.angular_impulse_W = computeAngularMomentum(
      handed_.q_WB_start, fromBullet(body_.getAngularVelocity() - handed_.expected_w));
  setPoseAndVelocity(handed_.end);
  return isFinite(change) ? change : HostChange{};
}

void HapticBody::applyWrench(const Vec3& f_W, const Vec3& t_W, double dt) noexcept {
  if (!isInWorld()) return;
  body_.applyCentralImpulse(toBullet(Vec3(f_W * dt)));
  body_.applyTorqueImpulse(toBullet(Vec3(t_W * dt)));
}

void HapticBody::remember() noexcept {
  if (!isInWorld()) return;
  known_pose_ = body_.getWorldTransform();
  known_v_ = body_.getLinearVelocity();
  known_w_ = body_.getAngularVelocity();
}

void HapticBody::setState(const RigidState& state) noexcept {
  if (isInWorld()) setPoseAndVelocity(state);
}

void HapticBody::setPoseAndVelocity(const RigidState& state) noexcept {
  // Velocities first: setting the pose copies them to where the motion state is interpolated from.
  body_.setLinearVelocity(toBullet(state.v_W));
  body_.setAngularVelocity(toBullet(state.w_W));
  body_.setCenterOfMassTransform(toBullet(state.p_W, state.q_WB));
  remember();
}

}  // namespace tandem
