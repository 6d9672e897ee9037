#include "bodies/guest_body.h"

#include <algorithm>

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "tandem/bullet_bridge/convert.h"

#include "bodies/rotation_vector.h"
#include "world/world_access.h"

namespace tandem {
namespace {

/// Smaller differences do not count as a change by the host [m, rad, m/s, rad/s].
constexpr double kNothing = 1e-9;
/// Share of a value that the host may lose by storing it as float, or by normalising a quaternion.
constexpr double kRounding = 0x1p-22;

bool isNothing(const Vec3& difference, double size) noexcept {
  return difference.norm() <= std::max(kNothing, kRounding * size);
}

/// A rotation angle is twice the error of its quaternion.
bool isSamePose(const RigidState& a, const RigidState& b) noexcept {
  return isNothing(a.p_W - b.p_W, b.p_W.norm()) &&
         isNothing(computeRotationVector(a.q_WB, b.q_WB), 2.0);
}

/// Change of a velocity; zero if it is negligible.
Vec3 computeChange(const Vec3& now, const Vec3& before, double size) noexcept {
  const Vec3 change = now - before;
  return isNothing(change, size) ? Vec3(Vec3::Zero()) : change;
}

}  // namespace

GuestBody::GuestBody(btDiscreteDynamicsWorld& world, btRigidBody& body) noexcept
    : world_(world), body_(body), told_(readState(body)), start_(told_), expected_(told_) {}

void GuestBody::takeHostChanges(const RigidState& now) noexcept {
  start_ = now;
  const Vec3 dv_W = computeChange(now.v_W, told_.v_W, told_.v_W.norm());
  const Vec3 dw_W = computeChange(now.w_W, told_.w_W, told_.w_W.norm());
  if (!isSamePose(now, told_)) {
    RigidState moved = readState(body_);
    moved.p_W = now.p_W;
    moved.q_WB = now.q_WB;
    putBody(world_, body_, moved);
  }
  if (dv_W != Vec3::Zero() || dw_W != Vec3::Zero()) pushBody(body_, dv_W, dw_W);
  told_ = now;
}

RigidState GuestBody::handOff(double dt, const Vec3& host_gravity_W) noexcept {
  told_ = readState(body_);
  expected_ = told_;
  expected_.v_W = (told_.p_W - start_.p_W) / dt;
  expected_.w_W = computeRotationVector(start_.q_WB, told_.q_WB) / dt;
  RigidState given = start_;
  given.v_W = expected_.v_W - dt * host_gravity_W;
  given.w_W = expected_.w_W;
  speed_ = std::max(expected_.v_W.norm(), given.v_W.norm());
  return given;
}

RigidState GuestBody::takeBack(const RigidState& now) noexcept {
  const Vec3 dv_W = computeChange(now.v_W, expected_.v_W, speed_);
  const Vec3 dw_W = computeChange(now.w_W, expected_.w_W, expected_.w_W.norm());
  if (dv_W != Vec3::Zero() || dw_W != Vec3::Zero()) {
    RigidState met = told_;
    met.p_W = now.p_W;
    met.q_WB = now.q_WB;
    putBody(world_, body_, met);
    pushBody(body_, dv_W, turnAlong(dw_W, start_.q_WB));
    told_ = readState(body_);
  }
  return told_;
}

/// Converts a change of angular velocity at orientation `from` to the body's present orientation,
/// with equal angular momentum.
Vec3 GuestBody::turnAlong(const Vec3& dw_W, const Quat& from) const noexcept {
  const Vec3 inertia = fromBullet(body_.getLocalInertia());
  const Vec3 inverse = fromBullet(body_.getInvInertiaDiagLocal());
  const Quat to = fromBullet(body_.getOrientation());
  const Vec3 momentum_W = from * inertia.cwiseProduct(from.conjugate() * dw_W);
  return to * inverse.cwiseProduct(to.conjugate() * momentum_W);
}

}  // namespace tandem
