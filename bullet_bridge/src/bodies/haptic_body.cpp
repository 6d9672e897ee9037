#include "bodies/haptic_body.h"

#include <cmath>
#include <limits>
#include <sstream>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include "tandem/bullet_bridge/convert.h"

#include "bodies/attach_warnings.h"
#include "bodies/body_number.h"
#include "bodies/equal_bits.h"
#include "bodies/mass_restore.h"
#include "bodies/rotation_vector.h"
#include "bodies/sleep_state.h"
#include "world/world_access.h"
#include "world/world_lookup.h"

// clang-format off
// One step of the host in hand-off mode, x over time:
//
//   pre-tick            Bullet's step                post-tick
//   x0 known     ─► v_avg = (end - x0) / dt ─►   pose and velocity := end
//
// Bullet adds its accumulated forces to the given velocity before it moves the body, so they are
// subtracted first. A difference of the velocity afterwards comes from its solver: contact with
// neighbours.
// clang-format on

namespace tandem {
namespace {

/// Damping that is off by our doing, not the host's.
constexpr btScalar kNoDamping = btScalar(-0.0);

constexpr int kGyroscopicFlags = BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT |
                                 BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD |
                                 BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY;

/// Above this speed Bullet's sleep timer is reset [m/s, rad/s].
constexpr double kTiredSpeed = 1e-4;

/// Farthest that Bullet's rounding moves a body at `p_W` from where it is led [m].
double computeRoundedWay(const Vec3& p_W) {
  return 1e-5 + 4.0 * static_cast<double>(std::numeric_limits<btScalar>::epsilon()) * p_W.norm();
}

/// True if Bullet's numbers hold the state, and the velocity that leads to it in a step.
bool fitsBullet(const RigidState& state) {
  const double most = 1e-6 * static_cast<double>(std::numeric_limits<btScalar>::max());
  return tandem::isFinite(state) && state.p_W.cwiseAbs().maxCoeff() < most &&
         state.v_W.cwiseAbs().maxCoeff() < most && state.w_W.cwiseAbs().maxCoeff() < most;
}

Vec3 readFactor(const btVector3& factor) {
  const Vec3 read = fromBullet(factor);
  const auto isSane = [](double one) { return std::isfinite(one) && one >= 0.0 ? one : 0.0; };
  return read.unaryExpr(isSane);
}

}  // namespace

void HapticBody::checkAttachable(const btDiscreteDynamicsWorld& world, const btRigidBody& body,
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

HapticBody::HapticBody(btDiscreteDynamicsWorld& world, btRigidBody& body, double mass_share,
                       Sleep sleep)
    : world_(world),
      body_(body),
      sleep_(sleep),
      world_index_(findInWorld(world, &body)),
      mass_share_(mass_share) {
  checkAttachable(world, body, mass_share);
  original_ = {body.getInvMass(),          body.getInvInertiaDiagLocal(), measureWeight(body),
               body.getLinearDamping(),    body.getAngularDamping(),      body.getActivationState(),
               body.getDeactivationTime(), body.getWorldTransform(),      world_index_};
  body.setDamping(kNoDamping, kNoDamping);
  has_additional_damping_ = hasAdditionalDamping(body);
  warnings_ = describeSurprises(body, original_.linear_damping, original_.angular_damping,
                                has_additional_damping_);
  if (sleep_ == Sleep::kNever && mayFallAsleep(original_.activation_state)) wake(body);
  if (mass_share != 1.0) scaleMass(mass_share);
  inverse_mass_ = body.getInvMass();
  inverse_inertia_ = body.getInvInertiaDiagLocal();
  look_ = BodyLook::at(body);
  // Sets the weight by a known computation, so that takeHostChanges() can separate it from the
  // host's forces to the bit.
  body.setGravity(body.getGravity());
  weight_ = measureWeight(body);
  remember();
}

HapticBody::~HapticBody() {
  if (is_gone_ || !isInWorld()) return;
  if (numberOf(body_) != look_.collider.number) return;  // another, made at its address
  if (handed_.pending) body_.setFlags(handed_.flags);
  takeDamping();
  body_.setDamping(original_.linear_damping, original_.angular_damping);
  // A body that was parked has missed a gravity that its world got meanwhile.
  if (parked_ && sleep_ == Sleep::kNever && hasMissedWorldGravity())
    body_.setGravity(world_.getGravity());
  restoreMassProps();
  if (sleep_ == Sleep::kNever) restoreActivation();
}

/// Restores mass and inertia, each unless the host has set another.
void HapticBody::restoreMassProps() {
  const bool is_own_mass = body_.getInvMass() == inverse_mass_;
  const bool is_own_inertia = equalBits(body_.getInvInertiaDiagLocal(), inverse_inertia_);
  const btVector3 inverse_inertia =
      is_own_inertia ? original_.inverse_inertia : body_.getInvInertiaDiagLocal();
  // The host may have set mass and weight anew to what they were. Bullet rounds a weight in two
  // ways.
  const bool has_own_share = inverse_mass_ != original_.inverse_mass;
  if (is_own_mass && (has_own_share || measureWeight(body_) == weight_)) {
    restoreMass(body_, original_.inverse_mass, inverse_inertia, original_.weight);
    // Bullet sets the weight of a body that is added, with another rounding.
    if (wasAddedAnew() && hasWorldGravity()) body_.setGravity(body_.getGravity());
  } else if (is_own_inertia) {
    body_.setInvInertiaDiagLocal(inverse_inertia);
    body_.updateInertiaTensor();
  }
}

/// Its number in the broadphase changes also without that.
bool HapticBody::wasAddedAnew() const noexcept {
  // A host may have deleted the shape by now: read nothing of it.
  const btBroadphaseProxy* proxy = body_.getBroadphaseHandle();
  const bool has_other_place = proxy && proxy->m_uniqueId != look_.collider.broadphase_id &&
                               world_index_ != original_.world_index;
  return was_away_ || has_other_place;
}

/// Reads a damping that the host set while ours is off, zero too: ours is minus zero.
void HapticBody::takeDamping() noexcept {
  const btScalar linear = body_.getLinearDamping(), angular = body_.getAngularDamping();
  if (!std::signbit(linear)) original_.linear_damping = linear;
  if (!std::signbit(angular)) original_.angular_damping = angular;
  body_.setDamping(kNoDamping, kNoDamping);
}

void HapticBody::endModelDamping() const noexcept { body_.setDamping(kNoDamping, kNoDamping); }

double HapticBody::linearDamping() const noexcept {
  return static_cast<double>(original_.linear_damping);
}
double HapticBody::angularDamping() const noexcept {
  return static_cast<double>(original_.angular_damping);
}

/// Gives the body a share of the mass that the host has given it.
void HapticBody::scaleMass(double share) noexcept {
  const auto factor = static_cast<btScalar>(share);
  const auto invert = [](btScalar value) { return value != 0 ? btScalar(1) / value : btScalar(0); };
  const btVector3& inverse = original_.inverse_inertia;
  const btVector3 inertia(invert(inverse.x()), invert(inverse.y()), invert(inverse.z()));
  body_.setMassProps(invert(original_.inverse_mass) * factor, inertia * factor);
  body_.updateInertiaTensor();
}

void HapticBody::setMassShare(double share) noexcept {
  if (!isInWorld() || !isAsHeld()) return;  // changed by the host: it is about to be held anew
  mass_share_ = share;
  const btVector3 weight_before = measureWeight(body_);
  scaleMass(share);
  body_.setGravity(body_.getGravity());
  inverse_mass_ = look_.inverse_mass = body_.getInvMass();
  inverse_inertia_ = look_.inverse_inertia = body_.getInvInertiaDiagLocal();
  weight_ = measureWeight(body_);
  // Bullet has applied the weight of this step.
  if (!isAsleep()) body_.applyCentralForce(weight_ - weight_before);
}

bool HapticBody::isInWorld() const noexcept {
  world_index_ = findInWorld(world_, &body_, world_index_);
  was_away_ |= world_index_ < 0;
  return world_index_ >= 0;
}

double HapticBody::mass() const noexcept { return 1.0 / static_cast<double>(body_.getInvMass()); }

Vec3 HapticBody::inertia() const noexcept { return fromBullet(body_.getLocalInertia()); }

Vec3 HapticBody::linearFactor() const noexcept { return readFactor(body_.getLinearFactor()); }
Vec3 HapticBody::angularFactor() const noexcept { return readFactor(body_.getAngularFactor()); }

Vec3 HapticBody::gravityForce() const noexcept {
  return fromBullet(body_.getGravity() * (btScalar(1) / body_.getInvMass()) *
                    body_.getLinearFactor());
}

RigidState HapticBody::state() const noexcept { return readState(body_); }

/// Bullet gives awake bodies their weight at the start of stepSimulation(). A body that woke
/// between its sub-steps lacks it.
void HapticBody::replaceMissingWeight() noexcept {
  const bool woke = slept_ && !isAsleep();
  if (isAsleep() && !slept_) rest_ = state();
  slept_ = isAsleep();
  if (woke && body_.getTotalForce().isZero()) body_.applyGravity();
}

Vec3 HapticBody::computeAngularMomentum(const Quat& q_WB, const Vec3& w_W) const noexcept {
  const Vec3 w_B = q_WB.conjugate() * w_W;
  return q_WB * inertia().cwiseProduct(w_B);
}

HostChange HapticBody::takeHostChanges(double dt) noexcept {
  HostChange change;
  if (!isInWorld()) return change;
  if (sleep_ == Sleep::kAsHost) takeDamping();
  replaceMissingWeight();
  const RigidState now = state();
  const bool asleep = isAsleep();
  if (!asleep) {
    change.f_W = fromBullet(body_.getTotalForce()) - gravityForce();
    change.t_W = fromBullet(body_.getTotalTorque());
    change.impulse_W = change.f_W * dt + (now.v_W - fromBullet(known_v_)) * mass();
    change.angular_impulse_W =
        change.t_W * dt + computeAngularMomentum(now.q_WB, now.w_W - fromBullet(known_w_));
  }
  if (!equalBits(body_.getWorldTransform(), known_pose_)) {
    change.moved = true;
    change.offset_W = now.p_W - fromBullet(known_pose_.getOrigin());
    change.rotation_W = now.q_WB * fromBullet(known_pose_.getRotation()).conjugate();
  }
  if (asleep) {
    known_pose_ = body_.getWorldTransform();
    if (change.moved) rest_ = now;
  } else {
    remember();
  }
  return isFinite(change) ? change : HostChange{};
}

void HapticBody::handOff(const RigidState& end, double dt, const Momentum& foreseen) noexcept {
  // A state that is not finite never reaches a host's body.
  if (!isInWorld() || !(dt > 0.0) || !fitsBullet(end)) return;
  handed_.asleep = isAsleep() && !hasLeftItsRest(end);
  if (isAsleep() && !handed_.asleep) {
    body_.activate(true);
    replaceMissingWeight();
  }
  const RigidState start = state();
  if (!handed_.pending) handed_.flags = body_.getFlags();
  handed_.end = end;
  handed_.p_W_start = start.p_W;
  handed_.q_WB_start = start.q_WB;
  handed_.pending = true;
  if (handed_.asleep) {
    handed_.expected_v = body_.getLinearVelocity();
    handed_.expected_w = body_.getAngularVelocity();
    return;
  }
  body_.setFlags(handed_.flags & ~kGyroscopicFlags);
  if (sleep_ == Sleep::kNever) stayAwake(dt);

  // Bullet's own arithmetic gives a free body exactly zero impulse.
  const auto step = static_cast<btScalar>(dt);
  const btVector3 by_force = body_.getTotalForce() * body_.getInvMass() * step;
  const btVector3 by_torque = body_.getTotalTorque() * body_.getInvInertiaTensorWorld() * step;
  btVector3 v = toBullet(Vec3((end.p_W - start.p_W) / dt)) - by_force;
  btVector3 w = toBullet(Vec3(computeRotationVector(start.q_WB, end.q_WB) / dt)) - by_torque;
  handed_.is_foreseen = !foreseen.isZero();
  handed_.foreseen_v = toBullet(foreseen.linear_W) * body_.getInvMass();
  handed_.foreseen_w = body_.getInvInertiaTensorWorld() * toBullet(foreseen.angular_W);
  if (handed_.is_foreseen) {
    v -= handed_.foreseen_v;
    w -= handed_.foreseen_w;
  }
  body_.setLinearVelocity(v);
  body_.setAngularVelocity(w);
  if (has_additional_damping_) body_.applyDamping(step);
  handed_.expected_v = body_.getLinearVelocity() + by_force;
  handed_.expected_w = body_.getAngularVelocity() + by_torque;
  body_.setLinearVelocity(v);
  body_.setAngularVelocity(w);
}

Vec3 HapticBody::computeExpectedVelocity(const Vec3& arm_W) const noexcept {
  if (!handed_.pending) return Vec3::Zero();
  return fromBullet(handed_.expected_v) + fromBullet(handed_.expected_w).cross(arm_W);
}

Vec3 HapticBody::computeForeseenVelocity(const Vec3& arm_W) const noexcept {
  if (!handed_.pending) return Vec3::Zero();
  return fromBullet(handed_.foreseen_v) + fromBullet(handed_.foreseen_w).cross(arm_W);
}

HostChange HapticBody::restore() noexcept {
  HostChange change;
  if (!handed_.pending || !isInWorld()) return change;
  handed_.pending = false;
  body_.setFlags(handed_.flags);
  if (handed_.asleep && isAsleep()) {
    body_.setCenterOfMassTransform(toBullet(handed_.end.p_W, handed_.end.q_WB));
    known_pose_ = body_.getWorldTransform();
    return change;
  }
  // Bullet zeroes the velocity of a body that it puts to sleep; that is no force.
  if (!isAsleep()) {
    change.impulse_W = fromBullet(body_.getLinearVelocity() - handed_.expected_v) * mass();
    change.angular_impulse_W = computeAngularMomentum(
        handed_.q_WB_start, fromBullet(body_.getAngularVelocity() - handed_.expected_w));
  }
  // Bullet's limits would let a body fall asleep that a hand still feels moving.
  const double speed = handed_.end.v_W.norm() + fromBullet(handed_.expected_v).norm();
  const double turning = handed_.end.w_W.norm() + fromBullet(handed_.expected_w).norm();
  if (speed > kTiredSpeed || turning > kTiredSpeed) body_.setDeactivationTime(0);
  if (!isAsleep()) readShift(change);
  setPoseAndVelocity(handed_.end);
  return isFinite(change) ? change : HostChange{};
}

/// Reads how the pose that Bullet's solver led to differs from the one handed off.
void HapticBody::readShift(HostChange& change) const noexcept {
  const RigidState& end = handed_.end;
  const RigidState met = state();
  const bool is_pushed = handed_.is_foreseen || change.impulse_W != Vec3::Zero() ||
                         change.angular_impulse_W != Vec3::Zero();
  // Continuous collision detection stops a body without an impulse.
  if (!is_pushed && (met.p_W - end.p_W).norm() < computeRoundedWay(end.p_W)) return;
  change.moved = true;
  change.offset_W = met.p_W - end.p_W;
  change.rotation_W = met.q_WB * end.q_WB.conjugate();
}

void HapticBody::place(const RigidState& state) noexcept {
  if (!isInWorld() || !fitsBullet(state)) return;
  handed_.end = state;
  setPoseAndVelocity(state);
}

void HapticBody::applyWrench(const Vec3& f_W, const Vec3& t_W, double dt) noexcept {
  if (!isInWorld()) return;
  stayAwake(dt);
  body_.applyCentralImpulse(toBullet(Vec3(f_W * dt)));
  body_.applyTorqueImpulse(toBullet(Vec3(t_W * dt)));
}

void HapticBody::addMomentum(const Vec3& linear_W, const Vec3& angular_W) noexcept {
  if (!isInWorld()) return;
  body_.setLinearVelocity(body_.getLinearVelocity() + toBullet(linear_W) * body_.getInvMass());
  body_.setAngularVelocity(body_.getAngularVelocity() +
                           body_.getInvInertiaTensorWorld() * toBullet(angular_W));
}

void HapticBody::remember() noexcept {
  if (!isInWorld()) return;
  known_pose_ = body_.getWorldTransform();
  known_v_ = body_.getLinearVelocity();
  known_w_ = body_.getAngularVelocity();
}

void HapticBody::shiftOrigin(const Vec3& offset_W) noexcept {
  const btVector3 offset = toBullet(offset_W);
  known_pose_.getOrigin() += offset;
  original_.pose.getOrigin() += offset;
  handed_.end.p_W += offset_W;
  rest_.p_W += offset_W;
}

void HapticBody::putBack() noexcept {
  if (isInWorld()) body_.setCenterOfMassTransform(known_pose_);
}

void HapticBody::setState(const RigidState& state) noexcept {
  if (isInWorld() && fitsBullet(state)) setPoseAndVelocity(state);
}

void HapticBody::setPoseAndVelocity(const RigidState& state) noexcept {
  // Velocities first: setting the pose copies them for the interpolation of the motion state.
  body_.setLinearVelocity(toBullet(state.v_W));
  body_.setAngularVelocity(toBullet(state.w_W));
  body_.setCenterOfMassTransform(toBullet(state.p_W, state.q_WB));
  remember();
}

}  // namespace tandem
