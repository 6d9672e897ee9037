#include "bodies/driven_body.h"

#include <algorithm>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "tandem/bullet_bridge/convert.h"

#include "bodies/rotation_vector.h"
#include "world/world_lookup.h"

namespace tandem {
namespace {

/// A slower body stands still [m/s, rad/s].
constexpr double kStillBelow = 1e-9;
/// Smaller differences of time are rounding of a velocity [s].
constexpr double kSameTime = 1e-6;
/// Longest duration of one stepSimulation() call [s].
constexpr double kLongestCall = 0.5;
constexpr double kJump = 0.05, kJumpTurn = 0.5;  // [m], [rad]
constexpr double kNear = 1e-7;                   // [m, rad]

bool isSamePose(const RigidState& a, const RigidState& b) {
  return a.p_W == b.p_W && a.q_WB.coeffs() == b.q_WB.coeffs();
}

bool stands(const RigidState& s) {
  return s.v_W.norm() < kStillBelow && s.w_W.norm() < kStillBelow;
}

/// Time from one pose to another at the velocities of the latter [s]; 0 for a jump.
double computeWayTime(const RigidState& from, const RigidState& to) {
  if (to.v_W.norm() >= kStillBelow) return (to.p_W - from.p_W).norm() / to.v_W.norm();
  if (to.w_W.norm() >= kStillBelow)
    return computeRotationVector(from.q_WB, to.q_WB).norm() / to.w_W.norm();
  return 0.0;
}

}  // namespace

DrivenBody::DrivenBody(btDiscreteDynamicsWorld& world, btRigidBody& body, double time) noexcept
    : world_(world), body_(body), world_index_(findInWorld(world, &body)), stamp_(time) {
  seen_ = read();
  // What it did before is unknown: it may have been made elsewhere.
  was_put_ = isLeap({}, seen_);
}

bool DrivenBody::isInWorld() const noexcept {
  world_index_ = findInWorld(world_, &body_, world_index_);
  return world_index_ >= 0;
}

RigidState DrivenBody::read() const noexcept {
  return {fromBullet(body_.getWorldTransform().getOrigin()),
          fromBullet(body_.getWorldTransform().getRotation()),
          fromBullet(body_.getLinearVelocity()), fromBullet(body_.getAngularVelocity())};
}

void DrivenBody::look(double time) noexcept {
  if (!isInWorld()) return;
  const RigidState now = read();
  const RigidState before = seen_;
  seen_ = now;
  if (isSamePose(now, before)) {
    if (time < stamp_ + kSameTime) return;
    is_belt_ = !stands(now);
    was_put_ = false;
    stamp_ = time;
    return;
  }
  is_belt_ = false;
  was_put_ = isPut(before, now, was_put_);
  // The first of several sub-steps already has the pose of the last.
  const double arrival = stamp_ + std::min(computeWayTime(before, now), kLongestCall);
  stamp_ = arrival > time + kSameTime ? arrival : time;
}

Motion DrivenBody::motion() const noexcept {
  return is_belt_ ? Motion::kHeld : Motion::kPrescribed;
}

RigidState DrivenBody::at(double time) const noexcept {
  RigidState state = seen_;
  if (was_put_) state.v_W = state.w_W = Vec3::Zero();
  if (!goesOn()) return state;
  state.p_W += (time - stamp_) * state.v_W;
  state.q_WB = (makeRotation((time - stamp_) * state.w_W) * state.q_WB).normalized();
  return state;
}

RigidState DrivenBody::steer(const RigidState& now, double time, double within) const noexcept {
  RigidState goal = at(time);
  if (!goesOn() || !(within > 0.0)) return goal;
  const Vec3 way_W = goal.p_W - now.p_W, turn_W = computeRotationVector(now.q_WB, goal.q_WB);
  const double way = way_W.norm(), turn = turn_W.norm();
  if (way > kJump || turn > kJumpTurn) return goal;
  if (stands(goal) && way < kNear && turn < kNear) return goal;
  RigidState state = now;
  state.v_W = goal.v_W + way_W / within;
  state.w_W = goal.w_W + turn_W / within;
  return state;
}

}  // namespace tandem
