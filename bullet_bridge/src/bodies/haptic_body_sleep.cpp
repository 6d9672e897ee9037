#include <cmath>
#include <cstring>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include "tandem/bullet_bridge/convert.h"

#include "bodies/equal_bits.h"
#include "bodies/haptic_body.h"
#include "bodies/mass_restore.h"
#include "bodies/rotation_vector.h"
#include "bodies/sleep_state.h"

// Sleep of a HapticBody: parked by the island, or as the host's Bullet decides.

namespace tandem {
namespace {

/// Limits for standing still: a thousandth of hand-off's accuracy [m, rad], [m/s, rad/s].
constexpr double kSamePlace = 1e-12;
constexpr double kSlow = 1e-9;

bool isZero(const btVector3& v) { return v.x() == 0 && v.y() == 0 && v.z() == 0; }

/// True if all are zero; has no branch per number.
template <typename... Vectors>
bool areZero(const Vectors&... vectors) {
  btScalar sum = 0;
  ((sum += std::abs(vectors.x()) + std::abs(vectors.y()) + std::abs(vectors.z())), ...);
  return sum == 0;
}

/// Compares all bytes: fast and strict. Minus zero differs from zero.
template <typename Value>
bool isSame(const Value& a, const Value& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

/// A body asleep in Bullet is not woken for a smaller move of its centre or surface [m].
constexpr double kTooLittleToWake = 5e-5;

}  // namespace

/// Restores sleep and its timer, unless the host has changed how the body is simulated.
void HapticBody::restoreActivation() {
  // It may have been woken by its host.
  if (parked_ && !is_stopped_) keepAwake();
  if (body_.getActivationState() != ACTIVE_TAG) return;
  const bool slept = mayFallAsleep(original_.activation_state);
  const bool untouched = equalBits(body_.getWorldTransform(), original_.pose);
  // Asleep in mid-air, a body would hang there.
  if (slept && untouched) body_.setActivationState(original_.activation_state);
  body_.setDeactivationTime(slept && !untouched ? 0 : original_.deactivation_time);
}

bool HapticBody::hasLeftItsRest(const RigidState& at) const noexcept {
  btVector3 middle;
  btScalar radius = 0;
  body_.getCollisionShape()->getBoundingSphere(middle, radius);
  const Vec3 turn_W = computeRotationVector(rest_.q_WB, at.q_WB);
  return (at.p_W - rest_.p_W).norm() > kTooLittleToWake ||
         static_cast<double>(radius) * turn_W.norm() > kTooLittleToWake;
}

bool HapticBody::standsAt(const RigidState& state) const noexcept {
  if (parked_ && sleep_ == Sleep::kAsHost) return !hasLeftItsRest(state);
  const auto is_below = [](const auto& v, double limit) { return v.squaredNorm() < limit * limit; };
  return is_below(state.p_W - handed_.end.p_W, kSamePlace) &&
         is_below(state.q_WB.coeffs() - handed_.end.q_WB.coeffs(), kSamePlace) &&
         is_below(state.v_W, kSlow) && is_below(state.w_W, kSlow);
}

void HapticBody::park() noexcept {
  if (parked_ || !isInWorld()) return;
  // Bullet decides about sleep, together with all bodies that it touches.
  if (sleep_ == Sleep::kAsHost && body_.isActive()) return;
  parkAt(handed_.end);
  body_.forceActivationState(ISLAND_SLEEPING);
}

bool HapticBody::wasPutToSleep() const noexcept {
  const bool is_parked_by_us = parked_ && !is_stopped_;
  if (sleep_ != Sleep::kNever || is_parked_by_us || !isInWorld()) return false;
  return body_.getActivationState() == ISLAND_SLEEPING &&
         !(is_stopped_ && isSame(body_.getWorldTransform(), known_pose_));
}

RigidState HapticBody::stop() noexcept {
  RigidState at = state();
  at.q_WB.normalize();
  at.v_W = at.w_W = Vec3::Zero();
  slept_ = true;  // Bullet gave it no weight, unless it fell asleep within its stepSimulation()
  parkAt(at);
  is_stopped_ = true;
  return handed_.end;
}

void HapticBody::parkAt(const RigidState& at) noexcept {
  layWeightDown();
  parked_ = slept_ = true;
  handed_.end = rest_ = at;
  handed_.p_W_start = at.p_W;
  standStill();
  known_gravity_ = body_.getGravity();
  known_world_gravity_ = world_.getGravity();
  known_look_ = BodyLook::at(body_);
  stays_awake_ = body_.getActivationState() == DISABLE_DEACTIVATION;
}

/// Bullet gives weight once for all sub-steps of a stepSimulation(). A body that parks between two
/// of them gets it anew when it wakes.
void HapticBody::layWeightDown() noexcept {
  const btVector3 total = body_.getTotalForce(), weight = measureWeight(body_);
  // A body that was asleep when the stepSimulation() began has none.
  const bool has_weight = !slept_ || total == weight * body_.getLinearFactor();
  if (has_weight && !isZero(total)) body_.applyCentralForce(-weight);
}

bool HapticBody::isUndisturbed() const noexcept {
  // The forces of a sleeping body do not include its weight. One that the host put to sleep loses
  // forces and impulses, as in Bullet.
  return body_.getActivationState() == ISLAND_SLEEPING &&
         (is_stopped_ || areZero(body_.getTotalForce(), body_.getTotalTorque(),
                                 body_.getLinearVelocity(), body_.getAngularVelocity())) &&
         isSame(body_.getGravity(), known_gravity_) &&
         isSame(body_.getWorldTransform(), known_pose_) && BodyLook::at(body_) == known_look_;
}

/// A body that is pinned when it is added gets no gravity from its world, then or later. One that
/// the host gave a gravity meanwhile keeps it.
bool HapticBody::hasMissedWorldGravity() const noexcept {
  return !is_stopped_ && hasWorldGravity() && !isSame(world_.getGravity(), known_world_gravity_) &&
         isSame(body_.getGravity(), known_gravity_) && !(body_.isStaticObject() && wasAddedAnew());
}

bool HapticBody::hasWorldGravity() const noexcept {
  return (body_.getFlags() & BT_DISABLE_WORLD_GRAVITY) == 0;
}

void HapticBody::standStill() noexcept {
  RigidState standing = handed_.end;
  standing.v_W.setZero();
  standing.w_W.setZero();
  setPoseAndVelocity(standing);
}

void HapticBody::unpark() noexcept {
  parked_ = false;
  if (!isInWorld()) return;
  // The world's new gravity reaches only awake bodies.
  if (hasMissedWorldGravity()) body_.setGravity(world_.getGravity());
  is_stopped_ = false;
  // Bullet gives weight only to bodies awake when a stepSimulation() begins.
  if (!body_.isActive()) body_.applyGravity();
  keepAwake();
}

void HapticBody::keepAwake() noexcept {
  if (mayFallAsleep(body_.getActivationState())) wake(body_);
  body_.setDeactivationTime(0);
  if (stays_awake_) body_.setActivationState(DISABLE_DEACTIVATION);
  stays_awake_ = slept_ = false;
}

/// Keeps Bullet from putting an awake body to sleep in this step of dt [s], whatever its limits.
void HapticBody::stayAwake(double dt) noexcept {
  if (body_.getActivationState() == WANTS_DEACTIVATION) wake(body_);
  // Bullet adds dt to the timer of a slow body.
  body_.setDeactivationTime(static_cast<btScalar>(-dt));
}

bool HapticBody::sleepsOn() noexcept {
  if (!body_.isActive()) return true;
  if (body_.getActivationState() == DISABLE_DEACTIVATION) return false;
  // Bullet wakes every body near an awake one; that alone moves nothing.
  if (!isZero(body_.getLinearVelocity()) || !isZero(body_.getAngularVelocity())) return false;
  standStill();
  body_.forceActivationState(ISLAND_SLEEPING);
  return true;
}

bool HapticBody::wakeIfHit(HostChange& change) noexcept {
  if (!parked_ || !isInWorld() || sleepsOn()) return false;
  parked_ = is_stopped_ = false;
  change = {};
  change.impulse_W = fromBullet(body_.getLinearVelocity()) * mass();
  change.angular_impulse_W =
      computeAngularMomentum(handed_.end.q_WB, fromBullet(body_.getAngularVelocity()));
  handed_.is_foreseen = false;
  readShift(change);
  standStill();
  keepAwake();
  // Weight for later sub-steps of this stepSimulation(), which clears it at its end.
  body_.applyGravity();
  if (!isFinite(change)) change = {};
  return true;
}

}  // namespace tandem
