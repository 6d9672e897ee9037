#include "arms/arm_constraint.h"

#include <algorithm>
#include <typeinfo>

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyGearConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>

#include "tandem/bullet_bridge/convert.h"

#include "arms/constraint_fields.h"
#include "joints/read_frame.h"

namespace tandem {
namespace {

/// Bullet mends an error by a part per step. The island closes it no faster than this: a fifth per
/// step at 500 Hz. Faster hosts would throw what is far open [1/s].
constexpr double kFastestMend = 100.0;

constexpr double kMostForce = 1e12;  // of a constraint without bound [N or N m]

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

/// Holds an axis by Bullet's bound, and mends a part of its error per step.
void hold(JointAxis& axis, const btMultiBodyConstraint& host, const HostSolver& solver) {
  if (!(host.getMaxAppliedImpulse() > 0)) return;
  axis.lock();
  axis.hold_force =
      std::min(static_cast<double>(host.getMaxAppliedImpulse()) / solver.dt, kMostForce);
  axis.erp = computeMend(1.0, solver) * solver.dt;
}

JointFrame readFrameAt(const btVector3& p, const btMatrix3x3& axes) {
  return readFrame(btTransform(axes, p), 0);
}

/// A slider's axes in its frame A: along it, and both that Bullet takes across.
Eigen::Matrix3d findSliderAxes(const btMultiBodySliderConstraint& slider) {
  const Eigen::Matrix3d frame = readFrameAt(slider.getPivotInA(), slider.getFrameInA()).axes;
  const Vec3 along = (frame.transpose() * fromBullet(slider.getJointAxis())).normalized();
  Eigen::Matrix3d axes;
  int first = 0;
  while (first < 2 && Vec3::Unit(first).cross(along).norm() < 1e-6) ++first;
  axes.col(0) = along;
  axes.col(1) = Vec3::Unit(first).cross(along).normalized();
  axes.col(2) = along.cross(axes.col(1));
  return axes;
}

void readPoint(btMultiBodyConstraint& host, const HostSolver& solver, JointSettings& joint) {
  const auto& point = static_cast<const btMultiBodyPoint2Point&>(host);
  joint.kind = JointKind::kPoint;
  joint.a.p = fromBullet(point.*PointFields::kPivotA);
  joint.b.p = fromBullet(point.getPivotInB());
  for (const std::size_t i : {0U, 1U, 2U}) hold(joint.axes[i], host, solver);
}

void readFixed(btMultiBodyConstraint& host, const HostSolver& solver, JointSettings& joint) {
  const auto& fixed = static_cast<const btMultiBodyFixedConstraint&>(host);
  joint.kind = JointKind::kWeld;
  joint.a = readFrameAt(fixed.getPivotInA(), fixed.getFrameInA());
  joint.b = readFrameAt(fixed.getPivotInB(), fixed.getFrameInB());
  for (JointAxis& axis : joint.axes) hold(axis, host, solver);
}

void readSlider(btMultiBodyConstraint& host, const HostSolver& solver, JointSettings& joint) {
  const auto& slider = static_cast<const btMultiBodySliderConstraint&>(host);
  joint.kind = JointKind::kRail;
  joint.a = readFrameAt(slider.getPivotInA(), slider.getFrameInA());
  joint.b = readFrameAt(slider.getPivotInB(), slider.getFrameInB());
  const Eigen::Matrix3d axes = findSliderAxes(slider);
  joint.a.axes *= axes;
  joint.b.axes *= axes;
  for (const std::size_t i : {1U, 2U, 3U, 4U, 5U}) hold(joint.axes[i], host, solver);
}

/// The rigid body of end B; null: it is no rigid body.
btRigidBody* findRigid(const btMultiBodyConstraint& host) {
  switch (findKind(host)) {
    case ArmConstraintKind::kPoint:
      return static_cast<const btMultiBodyPoint2Point&>(host).*PointFields::kRigidB;
    case ArmConstraintKind::kFixed:
      return static_cast<const btMultiBodyFixedConstraint&>(host).*FixedFields::kRigidB;
    case ArmConstraintKind::kSlider:
      return static_cast<const btMultiBodySliderConstraint&>(host).*SliderFields::kRigidB;
    default:
      return nullptr;
  }
}

const btMatrix3x3* findFrameInB(const btMultiBodyConstraint& host) {
  switch (findKind(host)) {
    case ArmConstraintKind::kFixed:
      return &static_cast<const btMultiBodyFixedConstraint&>(host).getFrameInB();
    case ArmConstraintKind::kSlider:
      return &static_cast<const btMultiBodySliderConstraint&>(host).getFrameInB();
    default:
      return nullptr;
  }
}

/// Bullet turns a rigid body's frame the wrong way: its solver and its error contradict each other,
/// unless the frame is that of the body.
bool isRigidFrameTurned(const btMultiBodyConstraint& host) {
  const btMatrix3x3* frame = findRigid(host) ? findFrameInB(host) : nullptr;
  return frame && !readFrameAt(btVector3(0, 0, 0), *frame).axes.isIdentity(1e-6);
}

}  // namespace

ArmConstraintKind findKind(const btMultiBodyConstraint& host) noexcept {
  const std::type_info& type = typeid(host);
  if (type == typeid(btMultiBodyJointMotor)) return ArmConstraintKind::kJointMotor;
  if (type == typeid(btMultiBodyJointLimitConstraint)) return ArmConstraintKind::kJointLimit;
  if (type == typeid(btMultiBodySphericalJointMotor)) return ArmConstraintKind::kSphericalMotor;
  if (type == typeid(btMultiBodySphericalJointLimit)) return ArmConstraintKind::kSphericalLimit;
  // Their ends A are links, by Bullet's constructors.
  if (!const_cast<btMultiBodyConstraint&>(host).getMultiBodyA()) return ArmConstraintKind::kUnknown;
  if (type == typeid(btMultiBodyGearConstraint)) return ArmConstraintKind::kGear;
  if (type == typeid(btMultiBodyPoint2Point)) return ArmConstraintKind::kPoint;
  if (type == typeid(btMultiBodyFixedConstraint)) return ArmConstraintKind::kFixed;
  if (type == typeid(btMultiBodySliderConstraint)) return ArmConstraintKind::kSlider;
  return ArmConstraintKind::kUnknown;
}

ArmConstraintEnds findEnds(btMultiBodyConstraint& host) noexcept {
  return {{host.getMultiBodyA(), host.getLinkA()},
          {host.getMultiBodyB(), host.getLinkB(), findRigid(host)}};
}

const char* findObstacleToHold(btMultiBodyConstraint& host) noexcept {
  const btRigidBody* const rigid = findRigid(host);
  // Bullet's solver has no number for such a body, and reads before the start of its list.
  if (rigid && rigid->isStaticOrKinematicObject())
    return "a constraint ties it to a static or kinematic body, which Bullet's solver does not "
           "find";
  switch (findKind(host)) {
    case ArmConstraintKind::kUnknown:
      return "it has a constraint of a type that the island does not know";
    case ArmConstraintKind::kGear:
      return "it has a gear, which couples more links than the island's joints do";
    case ArmConstraintKind::kSphericalMotor:
    case ArmConstraintKind::kSphericalLimit:
      if (host.getMultiBodyA()->getLink(host.getLinkA()).m_jointType != btMultibodyLink::eSpherical)
        return "a spherical motor or limit is on another joint";
      break;
    case ArmConstraintKind::kFixed:
    case ArmConstraintKind::kSlider:
      if (isRigidFrameTurned(host))
        return "a constraint has a turned frame on a rigid body, which Bullet turns the wrong way";
      break;
    case ArmConstraintKind::kJointMotor:
    case ArmConstraintKind::kJointLimit:
    case ArmConstraintKind::kPoint:
      break;
  }
  return nullptr;
}

JointSettings readConstraint(btMultiBodyConstraint& host, const HostSolver& solver) noexcept {
  JointSettings joint;
  joint.host_dt = solver.dt;
  switch (findKind(host)) {
    case ArmConstraintKind::kUnknown:
    case ArmConstraintKind::kGear:
    case ArmConstraintKind::kJointMotor:
    case ArmConstraintKind::kJointLimit:
      break;
    case ArmConstraintKind::kSphericalMotor:
      readSphericalMotor(host, solver, joint);
      break;
    case ArmConstraintKind::kSphericalLimit:
      readSphericalLimit(host, joint);
      break;
    case ArmConstraintKind::kPoint:
      readPoint(host, solver, joint);
      break;
    case ArmConstraintKind::kFixed:
      readFixed(host, solver, joint);
      break;
    case ArmConstraintKind::kSlider:
      readSlider(host, solver, joint);
      break;
  }
  return joint;
}

Vec3 turnToFrame(btMultiBodyConstraint& slider, const Vec3& by_axes) noexcept {
  return findSliderAxes(static_cast<const btMultiBodySliderConstraint&>(slider)) * by_axes;
}

}  // namespace tandem
