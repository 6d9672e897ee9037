#include "arms/arm_constraint.h"

#include <algorithm>
#include <typeinfo>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodySphericalJointLimit.h>
#include <BulletDynamics/Featherstone/btMultiBodySphericalJointMotor.h>

#include "tandem/bullet_bridge/convert.h"

#include "arms/spherical_fields.h"

namespace tandem {
namespace {

/// Bullet mends an error by a part per step. The island's ticks follow no faster than this [1/s].
constexpr double kFastestMend = 500.0;

double computeMend(double part, const HostSolver& solver) {
  return std::min(part * solver.erp / solver.dt, kFastestMend);
}

/// Orientation of a spherical joint's link in its parent while the joint is at `at`.
Eigen::Matrix3d findAxesInParent(btMultiBodyConstraint& host, const Quat& at) {
  const btMultibodyLink& link = host.getMultiBodyA()->getLink(host.getLinkA());
  return (fromBullet(link.m_zeroRotParentToThis).conjugate() * at).toRotationMatrix();
}

/// Bullet's speed and erp of it are unused there, as Bullet does not use them.
void readSphericalMotor(btMultiBodyConstraint& host, const HostSolver& solver,
                        JointSettings& joint) {
  const auto& motor = static_cast<const btMultiBodySphericalJointMotor&>(host);
  joint.kind = JointKind::kWeld;
  joint.holds_points = false;
  joint.b.axes = findAxesInParent(host, fromBullet(motor.*SphericalMotorFields::kTarget));
  if (!(motor.getMaxAppliedImpulse() > 0)) return;
  const bool is_each = motor.*SphericalMotorFields::kIsEach;
  for (int i = 0; i < 3; ++i) {
    JointAxis& axis = joint.axes[static_cast<std::size_t>(3 + i)];
    axis.motor = JointMotor::kDrive;
    const btScalar most =
        is_each ? motor.getMaxAppliedImpulseMultiDof(i) : motor.getMaxAppliedImpulse();
    axis.force = static_cast<double>(most) / solver.dt;
    const btScalar gain = (motor.*SphericalMotorFields::kP)[is_each ? i : 0];
    axis.gain = computeMend(static_cast<double>(gain), solver);
    axis.share = static_cast<double>(motor.getDamping(i));
  }
}

/// Ranges of the link's tilts about its own x and y, and of its turn about z.
void readSphericalLimit(btMultiBodyConstraint& host, JointSettings& joint) {
  const auto& limit = static_cast<const btMultiBodySphericalJointLimit&>(host);
  joint.kind = JointKind::kTiltTurn;
  joint.b.axes = findAxesInParent(host, Quat::Identity());
  if (!(limit.getMaxAppliedImpulse() > 0)) return;
  const double ranges[] = {static_cast<double>(limit.*SphericalLimitFields::kX),
                           static_cast<double>(limit.*SphericalLimitFields::kY),
                           static_cast<double>(limit.*SphericalLimitFields::kTwist)};
  const double widest[] = {M_PI, M_PI / 2.0, M_PI};  // of each coordinate
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(ranges[i] > 0.0) || ranges[i] >= widest[i]) continue;
    joint.axes[3 + i].low = -ranges[i];
    joint.axes[3 + i].high = ranges[i];
  }
}

}  // namespace

ArmConstraintKind findKind(const btMultiBodyConstraint& host) noexcept {
  const std::type_info& type = typeid(host);
  if (type == typeid(btMultiBodyJointMotor)) return ArmConstraintKind::kJointMotor;
  if (type == typeid(btMultiBodyJointLimitConstraint)) return ArmConstraintKind::kJointLimit;
  if (type == typeid(btMultiBodySphericalJointMotor)) return ArmConstraintKind::kSphericalMotor;
  if (type == typeid(btMultiBodySphericalJointLimit)) return ArmConstraintKind::kSphericalLimit;
  return ArmConstraintKind::kUnknown;
}

ArmConstraintEnds findEnds(btMultiBodyConstraint& host) noexcept {
  return {{host.getMultiBodyA(), host.getLinkA()}, {host.getMultiBodyB(), host.getLinkB()}};
}

const char* findObstacleToHold(btMultiBodyConstraint& host) noexcept {
  switch (findKind(host)) {
    case ArmConstraintKind::kUnknown:
      return "it has a constraint of a type that the island does not know";
    case ArmConstraintKind::kSphericalMotor:
    case ArmConstraintKind::kSphericalLimit:
      if (host.getMultiBodyA()->getLink(host.getLinkA()).m_jointType != btMultibodyLink::eSpherical)
        return "a spherical motor or limit is on another joint";
      break;
    case ArmConstraintKind::kJointMotor:
    case ArmConstraintKind::kJointLimit:
      break;
  }
  return nullptr;
}

JointSettings readConstraint(btMultiBodyConstraint& host, const HostSolver& solver) noexcept {
  JointSettings joint;
  joint.host_dt = solver.dt;
  switch (findKind(host)) {
    case ArmConstraintKind::kUnknown:
    case ArmConstraintKind::kJointMotor:
    case ArmConstraintKind::kJointLimit:
      break;
    case ArmConstraintKind::kSphericalMotor:
      readSphericalMotor(host, solver, joint);
      break;
    case ArmConstraintKind::kSphericalLimit:
      readSphericalLimit(host, joint);
      break;
  }
  return joint;
}

}  // namespace tandem
