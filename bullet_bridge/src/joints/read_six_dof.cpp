#include "joints/read_six_dof.h"

#include <algorithm>

#include "joints/read_frame.h"

namespace tandem {
namespace {

/// Rates of ways are against u, those of angles along it: Bullet measures b from a, and angles of
/// a in b.
void startAxes(JointSettings& joint) {
  joint.kind = JointKind::kSixDof;
  for (std::size_t i = 0; i < 6; ++i) joint.axes[i].sense = i < 3 ? -1 : 1;
}

void readAngle(const btRotationalLimitMotor& limit, int flags, const HostSolver& solver,
               JointAxis& axis) {
  axis.low = limit.m_loLimit;
  axis.high = limit.m_hiLimit;
  axis.bounce = std::clamp<double>(limit.m_bounce, 0.0, 1.0);
  axis.erp = (flags & BT_6DOF_FLAGS_ERP_STOP) ? limit.m_stopERP : solver.erp;
  axis.cfm = (flags & BT_6DOF_FLAGS_CFM_STOP) ? limit.m_stopCFM : 0.0;
  if (!limit.m_enableMotor) return;
  axis.motor = JointMotor::kSpeed;
  axis.speed = limit.m_targetVelocity;
  axis.force = limit.m_maxMotorForce;
}

void readWay(const btTranslationalLimitMotor& limits, int i, int flags, const HostSolver& solver,
             JointAxis& axis) {
  axis.low = limits.m_lowerLimit[i];
  axis.high = limits.m_upperLimit[i];
  axis.erp = (flags & BT_6DOF_FLAGS_ERP_STOP) ? limits.m_stopERP[i] : solver.erp;
  axis.cfm = (flags & BT_6DOF_FLAGS_CFM_STOP) ? limits.m_stopCFM[i] : 0.0;
  if (!limits.m_enableMotor[i]) return;
  axis.motor = JointMotor::kSpeed;
  // Bullet drives against its own way.
  axis.speed = limits.m_targetVelocity[i];
  axis.force = limits.m_maxMotorForce[i];
}

void readAngle(const btRotationalLimitMotor2& limit, int flags, const HostSolver& solver,
               JointAxis& axis) {
  axis.low = limit.m_loLimit;
  axis.high = limit.m_hiLimit;
  axis.bounce = std::clamp<double>(limit.m_bounce, 0.0, 1.0);
  axis.erp = (flags & BT_6DOF_FLAGS_ERP_STOP2) ? limit.m_stopERP : solver.erp;
  axis.cfm = (flags & BT_6DOF_FLAGS_CFM_STOP2) ? limit.m_stopCFM : 0.0;
  if (limit.m_enableMotor) {
    axis.motor = limit.m_servoMotor ? JointMotor::kServo : JointMotor::kSpeed;
    axis.speed = limit.m_targetVelocity;
    axis.force = limit.m_maxMotorForce;
    axis.target = limit.m_servoTarget;
    axis.gain = ((flags & BT_6DOF_FLAGS_ERP_MOTO2) ? limit.m_motorERP : solver.erp) / solver.dt;
  }
  axis.has_spring = limit.m_enableSpring;
  axis.stiffness = limit.m_springStiffness;
  axis.damping = limit.m_springDamping;
  axis.rest = limit.m_equilibriumPoint;
}

void readWay(const btTranslationalLimitMotor2& limits, int i, int flags, const HostSolver& solver,
             JointAxis& axis) {
  axis.low = limits.m_lowerLimit[i];
  axis.high = limits.m_upperLimit[i];
  axis.bounce = std::clamp<double>(limits.m_bounce[i], 0.0, 1.0);
  axis.erp = (flags & BT_6DOF_FLAGS_ERP_STOP2) ? limits.m_stopERP[i] : solver.erp;
  axis.cfm = (flags & BT_6DOF_FLAGS_CFM_STOP2) ? limits.m_stopCFM[i] : 0.0;
  if (limits.m_enableMotor[i]) {
    axis.motor = limits.m_servoMotor[i] ? JointMotor::kServo : JointMotor::kSpeed;
    // Bullet drives against its own way, unless it is a servo.
    axis.speed = limits.m_targetVelocity[i];
    axis.force = limits.m_maxMotorForce[i];
    axis.target = limits.m_servoTarget[i];
    axis.gain = ((flags & BT_6DOF_FLAGS_ERP_MOTO2) ? limits.m_motorERP[i] : solver.erp) / solver.dt;
  }
  axis.has_spring = limits.m_enableSpring[i];
  axis.stiffness = limits.m_springStiffness[i];
  axis.damping = limits.m_springDamping[i];
  axis.rest = limits.m_equilibriumPoint[i];
}

/// Reaches the flags, which have no getter.
class FlagsOfSpring2 final : btGeneric6DofSpring2Constraint {
 public:
  static int of(const btGeneric6DofSpring2Constraint& host) {
    return host.*(&FlagsOfSpring2::m_flags);
  }
};

std::array<int, 3> findOrder(RotateOrder order) {
  switch (order) {
    case RO_XYZ:
      return {0, 1, 2};
    case RO_XZY:
      return {0, 2, 1};
    case RO_YXZ:
      return {1, 0, 2};
    case RO_YZX:
      return {1, 2, 0};
    case RO_ZXY:
      return {2, 0, 1};
    case RO_ZYX:
      return {2, 1, 0};
  }
  return {0, 1, 2};
}

}  // namespace

void readSixDof(btGeneric6DofConstraint& host, const HostSolver& solver, JointSettings& joint) {
  startAxes(joint);
  joint.a = readFrame(host.getFrameOffsetA(), 0);
  joint.b = readFrame(host.getFrameOffsetB(), 0);
  for (int i = 0; i < 3; ++i) {
    const auto way = static_cast<std::size_t>(i);
    readWay(*host.getTranslationalLimitMotor(), i,
            host.getFlags() >> (i * BT_6DOF_FLAGS_AXIS_SHIFT), solver, joint.axes[way]);
    readAngle(*host.getRotationalLimitMotor(i),
              host.getFlags() >> ((i + 3) * BT_6DOF_FLAGS_AXIS_SHIFT), solver, joint.axes[way + 3]);
  }
}

void readSixDofSpring(btGeneric6DofSpringConstraint& host, const HostSolver& solver,
                      JointSettings& joint) {
  readSixDof(host, solver, joint);
  for (int i = 0; i < 6; ++i) {
    JointAxis& axis = joint.axes[static_cast<std::size_t>(i)];
    if (axis.motor == JointMotor::kNone || !host.isSpringEnabled(i)) continue;
    axis.motor = JointMotor::kSpring;
    axis.stiffness = host.getStiffness(i);
    axis.rest = host.getEquilibriumPoint(i);
    axis.gain = host.getDamping(i) / (solver.dt * std::max(solver.iterations, 1));
  }
}

void readSixDofSpring2(btGeneric6DofSpring2Constraint& host, const HostSolver& solver,
                       JointSettings& joint) {
  startAxes(joint);
  joint.a = readFrame(host.getFrameOffsetA(), 0);
  joint.b = readFrame(host.getFrameOffsetB(), 0);
  joint.order = findOrder(host.getRotationOrder());
  const int flags = FlagsOfSpring2::of(host);
  for (int i = 0; i < 3; ++i) {
    const auto way = static_cast<std::size_t>(i);
    readWay(*host.getTranslationalLimitMotor(), i, flags >> (i * BT_6DOF_FLAGS_AXIS_SHIFT2), solver,
            joint.axes[way]);
    readAngle(*host.getRotationalLimitMotor(i), flags >> ((i + 3) * BT_6DOF_FLAGS_AXIS_SHIFT2),
              solver, joint.axes[way + 3]);
  }
}

}  // namespace tandem
