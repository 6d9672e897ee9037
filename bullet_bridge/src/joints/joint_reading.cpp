#include "joints/joint_reading.h"

#include <algorithm>
#include <typeinfo>

#include <BulletDynamics/ConstraintSolver/btFixedConstraint.h>
#include <BulletDynamics/ConstraintSolver/btGearConstraint.h>
#include <BulletDynamics/ConstraintSolver/btHinge2Constraint.h>
#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>
#include <BulletDynamics/ConstraintSolver/btPoint2PointConstraint.h>
#include <BulletDynamics/ConstraintSolver/btSliderConstraint.h>
#include <BulletDynamics/ConstraintSolver/btUniversalConstraint.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "tandem/bullet_bridge/convert.h"

#include "joints/read_cone_twist.h"
#include "joints/read_frame.h"
#include "joints/read_six_dof.h"

namespace tandem {
namespace {

enum class HostJoint : std::uint8_t {
  kUnknown,
  kPoint,
  kHinge,
  kSlider,
  kConeTwist,
  kSixDof,
  kSixDofSpring,
  kSixDofSpring2,
  kGear,
};

/// Types of one family share what they compute. getConstraintType() tells too few apart.
HostJoint findHostJoint(const btTypedConstraint& host) noexcept {
  const std::type_info& type = typeid(host);
  if (type == typeid(btPoint2PointConstraint)) return HostJoint::kPoint;
  if (type == typeid(btHingeConstraint)) return HostJoint::kHinge;
  if (type == typeid(btHingeAccumulatedAngleConstraint)) return HostJoint::kHinge;
  if (type == typeid(btSliderConstraint)) return HostJoint::kSlider;
  if (type == typeid(btConeTwistConstraint)) return HostJoint::kConeTwist;
  if (type == typeid(btGeneric6DofConstraint)) return HostJoint::kSixDof;
  if (type == typeid(btUniversalConstraint)) return HostJoint::kSixDof;
  if (type == typeid(btGeneric6DofSpringConstraint)) return HostJoint::kSixDofSpring;
  if (type == typeid(btGeneric6DofSpring2Constraint)) return HostJoint::kSixDofSpring2;
  if (type == typeid(btHinge2Constraint)) return HostJoint::kSixDofSpring2;
  if (type == typeid(btFixedConstraint)) return HostJoint::kSixDofSpring2;
  if (type == typeid(btGearConstraint)) return HostJoint::kGear;
  return HostJoint::kUnknown;
}

void readPoint(btPoint2PointConstraint& host, const HostSolver& solver, JointSettings& joint) {
  joint.kind = JointKind::kPoint;
  joint.a.p = fromBullet(host.getPivotInA());
  joint.b.p = fromBullet(host.getPivotInB());
  const int flags = host.getFlags();
  const double clamp = host.m_setting.m_impulseClamp;
  for (std::size_t i = 0; i < 3; ++i) {
    JointAxis& axis = joint.axes[i];
    axis.lock();
    axis.erp = (flags & BT_P2P_FLAGS_ERP) ? host.getParam(BT_CONSTRAINT_ERP) : solver.erp;
    axis.cfm = (flags & BT_P2P_FLAGS_CFM) ? host.getParam(BT_CONSTRAINT_CFM) : 0.0;
    if (clamp > 0.0) axis.hold_force = clamp / solver.dt;
  }
}

/// Sense of the hinge's angle. Bullet has no getter of it, and the flag may be changed without it.
int findHingeSense(btHingeConstraint& host) {
  const btTransform a = host.getAFrame().inverse();
  const btTransform turned(btQuaternion(btVector3(0, 0, 1), btScalar(1)));
  const btTransform b = turned * host.getBFrame().inverse();
  // Frame b stands 1 rad about z from frame a: the plain angle is -1 rad.
  return host.getHingeAngle(a, b) < 0 ? 1 : -1;
}

void readHinge(btHingeConstraint& host, const HostSolver& solver, JointSettings& joint) {
  joint.kind = JointKind::kHinge;
  joint.a = readFrame(host.getAFrame(), 2);
  joint.b = readFrame(host.getBFrame(), 2);
  joint.holds_points = !host.getAngularOnly();
  for (std::size_t i = 0; i < 5; ++i) joint.axes[i].lock();
  const int flags = host.getFlags();
  const double erp = (flags & BT_HINGE_FLAGS_ERP_NORM)
                         ? static_cast<double>(host.getParam(BT_CONSTRAINT_ERP))
                         : solver.erp;
  JointAxis& turn = joint.axes[5];
  turn.sense = findHingeSense(host);
  turn.low = host.getLowerLimit();
  turn.high = host.getUpperLimit();
  turn.bounce =
      std::clamp<double>(host.getLimitRelaxationFactor() * host.getLimitBiasFactor(), 0, 1);
  turn.erp = (flags & BT_HINGE_FLAGS_ERP_STOP) ? host.getParam(BT_CONSTRAINT_STOP_ERP) : erp;
  turn.erp *= host.getLimitBiasFactor();
  turn.cfm = (flags & BT_HINGE_FLAGS_CFM_STOP) ? host.getParam(BT_CONSTRAINT_STOP_CFM) : 0.0;
  if (!host.getEnableAngularMotor()) return;
  turn.motor = JointMotor::kSpeed;
  turn.speed = turn.sense * static_cast<double>(host.getMotorTargetVelocity());
  turn.force = static_cast<double>(host.getMaxMotorImpulse()) / solver.dt;
}

/// `index` is the slider's own: 0 along, 1 sideways, 3 about, 4 tilt.
double readSliderCfm(btSliderConstraint& host, int flag, int index) {
  return (host.getFlags() & flag) ? host.getParam(BT_CONSTRAINT_STOP_CFM, index) : 0.0;
}

void readSliderLocks(btSliderConstraint& host, const HostSolver& solver, JointSettings& joint) {
  const int flags = host.getFlags();
  for (const std::size_t i : {1u, 2u, 4u, 5u}) {
    const bool is_linear = i < 3;
    JointAxis& axis = joint.axes[i];
    axis.lock();
    axis.erp = is_linear ? host.getSoftnessOrthoLin() : host.getSoftnessOrthoAng();
    if (!(flags & (is_linear ? BT_SLIDER_FLAGS_ERP_ORTLIN : BT_SLIDER_FLAGS_ERP_ORTANG)))
      axis.erp *= solver.erp;
    axis.cfm = is_linear ? readSliderCfm(host, BT_SLIDER_FLAGS_CFM_ORTLIN, 1)
                         : readSliderCfm(host, BT_SLIDER_FLAGS_CFM_ORTANG, 4);
  }
}

void readSlider(btSliderConstraint& host, const HostSolver& solver, JointSettings& joint) {
  joint.kind = JointKind::kSlider;
  joint.a = readFrame(host.getFrameOffsetA(), 0);
  joint.b = readFrame(host.getFrameOffsetB(), 0);
  readSliderLocks(host, solver, joint);
  const int flags = host.getFlags();

  JointAxis& along = joint.axes[0];
  along.sense = host.getUseLinearReferenceFrameA() ? -1 : 1;
  along.low = host.getLowerLinLimit();
  along.high = host.getUpperLinLimit();
  const double soft_along = host.getSoftnessLimLin();
  along.bounce = std::clamp(
      std::abs(1.0 - static_cast<double>(host.getDampingLimLin())) * soft_along, 0.0, 1.0);
  along.erp = soft_along * ((flags & BT_SLIDER_FLAGS_ERP_LIMLIN) ? soft_along : solver.erp);
  along.cfm = readSliderCfm(host, BT_SLIDER_FLAGS_CFM_LIMLIN, 0);
  if (host.getPoweredLinMotor()) {
    along.motor = JointMotor::kSpeed;
    along.speed = along.sense * static_cast<double>(host.getTargetLinMotorVelocity());
    along.force = host.getMaxLinMotorForce();
  }

  JointAxis& about = joint.axes[3];
  about.sense = -1;
  about.low = host.getLowerAngLimit();
  about.high = host.getUpperAngLimit();
  const double soft_about = host.getSoftnessLimAng();
  about.bounce = std::clamp(
      std::abs(1.0 - static_cast<double>(host.getDampingLimAng())) * soft_about, 0.0, 1.0);
  about.erp = soft_about * ((flags & BT_SLIDER_FLAGS_ERP_LIMANG) ? soft_about : solver.erp);
  about.cfm = readSliderCfm(host, BT_SLIDER_FLAGS_CFM_LIMANG, 3);
  if (host.getPoweredAngMotor()) {
    about.motor = JointMotor::kSpeed;
    // Bullet turns against its own angle.
    about.speed = host.getTargetAngMotorVelocity();
    about.force = host.getMaxAngMotorForce();
  }
}

void readGear(const btGearConstraint& host, JointSettings& joint) {
  joint.kind = JointKind::kGear;
  joint.a.p = fromBullet(host.getAxisA());
  joint.b.p = fromBullet(host.getAxisB());
  joint.gear_ratio = host.getRatio();
}

EndMass readMass(const btRigidBody& body) {
  EndMass mass;
  if (body.isStaticOrKinematicObject()) return mass;
  mass.inverse_mass = body.getInvMass();
  mass.inverse_inertia_B = fromBullet(body.getInvInertiaDiagLocal());
  return mass;
}

}  // namespace

bool isKnownJoint(const btTypedConstraint& host) noexcept {
  return findHostJoint(host) != HostJoint::kUnknown;
}

JointSettings readJoint(btTypedConstraint& host, const HostSolver& solver) noexcept {
  JointSettings joint;
  joint.host_dt = solver.dt;
  joint.mass_a = readMass(host.getRigidBodyA());
  joint.mass_b = readMass(host.getRigidBodyB());
  joint.is_enabled = host.isEnabled();
  // Bullet's infinity of either width.
  const double threshold = host.getBreakingImpulseThreshold();
  if (threshold < BT_LARGE_FLOAT) joint.breaking_impulse = threshold;
  switch (findHostJoint(host)) {
    case HostJoint::kUnknown:
      break;
    case HostJoint::kPoint:
      readPoint(static_cast<btPoint2PointConstraint&>(host), solver, joint);
      break;
    case HostJoint::kHinge:
      readHinge(static_cast<btHingeConstraint&>(host), solver, joint);
      break;
    case HostJoint::kSlider:
      readSlider(static_cast<btSliderConstraint&>(host), solver, joint);
      break;
    case HostJoint::kConeTwist:
      readConeTwist(static_cast<btConeTwistConstraint&>(host), solver, joint);
      break;
    case HostJoint::kSixDof:
      readSixDof(static_cast<btGeneric6DofConstraint&>(host), solver, joint);
      break;
    case HostJoint::kSixDofSpring:
      readSixDofSpring(static_cast<btGeneric6DofSpringConstraint&>(host), solver, joint);
      break;
    case HostJoint::kSixDofSpring2:
      readSixDofSpring2(static_cast<btGeneric6DofSpring2Constraint&>(host), solver, joint);
      break;
    case HostJoint::kGear:
      readGear(static_cast<const btGearConstraint&>(host), joint);
      break;
  }
  return joint;
}

}  // namespace tandem
