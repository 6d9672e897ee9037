#include "native/support_line.h"

#include <algorithm>
#include <cmath>

#include "tandem/bullet_bridge/convert.h"

#include "bodies/rotation_vector.h"
#include "coordination/src/island/locked_axis.h"

namespace tandem {

SupportSide::SupportSide(const SupportBody& of, const Vec3& p_W) : body(of) {
  if (!body.bullet) return;
  const btRigidBody& rigid = body.bullet->body();
  mass = body.bullet->mass();
  arm_W = p_W - body.bullet->solvedAt();
  q_WB = fromBullet(rigid.getWorldTransform().getRotation());
  inverse_mass = static_cast<double>(rigid.getInvMass()) * fromBullet(rigid.getLinearFactor());
  const btMatrix3x3& inertia = rigid.getInvInertiaTensorWorld();
  const Vec3 factor = fromBullet(rigid.getAngularFactor());
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      free_inverse_inertia_W(row, column) = static_cast<double>(inertia[row][column]);
  inverse_inertia_W = factor.asDiagonal() * free_inverse_inertia_W;
}

Vec3 SupportSide::expect() const noexcept {
  return body.bullet ? body.bullet->computeExpectedVelocity(arm_W) : Vec3(Vec3::Zero());
}

Vec3 SupportSide::foresee() const noexcept {
  return body.bullet ? body.bullet->computeForeseenVelocity(arm_W) : Vec3(Vec3::Zero());
}

Vec3 SupportSide::computeChange() const noexcept {
  if (!body.change) return Vec3::Zero();
  const Vec3 turn_W = free_inverse_inertia_W * body.change->angular_impulse_W;
  return body.change->impulse_W / mass + turn_W.cross(arm_W);
}

double SupportSide::computeInverseMass(const Vec3& along_W) const noexcept {
  const Vec3 turn_W = arm_W.cross(along_W);
  return along_W.dot(inverse_mass.cwiseProduct(along_W)) + turn_W.dot(inverse_inertia_W * turn_W);
}

void SupportSide::give(const Vec3& j_W, double dt) const noexcept {
  if (!body.change) return;
  HostChange& change = *body.change;
  const Vec3 dv_W = inverse_mass.cwiseProduct(j_W);
  const Vec3 dw_W = inverse_inertia_W * arm_W.cross(j_W);
  change.impulse_W += mass * dv_W;
  change.angular_impulse_W += body.bullet->computeAngularMomentum(q_WB, dw_W);
  change.moved = true;
  change.offset_W += dt * dv_W;
  change.rotation_W = makeRotation(dt * dw_W) * change.rotation_W;
}

SupportLine::SupportLine(const SupportBody& body_a, const SupportBody& body_b, const Vec3& p_W,
                         const Vec3& along, double free)
    : a(body_a, p_W),
      b(body_b, p_W),
      along_W(along),
      free_speed(free),
      inverse_mass(a.computeInverseMass(along) + b.computeInverseMass(along)) {
  if (isLocked(inverse_mass, a.freeInverseMass() + b.freeInverseMass())) inverse_mass = 0.0;
}

double SupportLine::improve(double least, double most, double dt) noexcept {
  if (!(inverse_mass > 0.0)) return 0.0;
  const double speed = along_W.dot(a.computeChange() - b.computeChange()) - free_speed;
  const double before = impulse;
  impulse = std::clamp(before - speed / inverse_mass, least, most);
  const double change = impulse - before;
  if (change == 0.0) return 0.0;
  a.give(change * along_W, dt);
  b.give(-change * along_W, dt);
  return std::abs(change);
}

}  // namespace tandem
