#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyFixedConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyPoint2Point.h>
#include <BulletDynamics/Featherstone/btMultiBodySliderConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodySphericalJointLimit.h>
#include <BulletDynamics/Featherstone/btMultiBodySphericalJointMotor.h>

namespace tandem {

// Bullet shows these to derived classes only.

struct ConstraintFields : btMultiBodyConstraint {
  static constexpr auto kData = &ConstraintFields::m_data;
};

struct MotorFields : btMultiBodyJointMotor {
  static constexpr auto kSpeed = &MotorFields::m_desiredVelocity;
  static constexpr auto kPlace = &MotorFields::m_desiredPosition;
  static constexpr auto kP = &MotorFields::m_kp;
  static constexpr auto kD = &MotorFields::m_kd;
  static constexpr auto kErp = &MotorFields::m_erp;
  static constexpr auto kMost = &MotorFields::m_rhsClamp;
};

struct SphericalMotorFields : btMultiBodySphericalJointMotor {
  static constexpr auto kTarget = &SphericalMotorFields::m_desiredPosition;
  static constexpr auto kP = &SphericalMotorFields::m_kp;
  /// Axes have gains and impulses of their own.
  static constexpr auto kIsEach = &SphericalMotorFields::m_use_multi_dof_params;
  static constexpr auto kMostOfEach = &SphericalMotorFields::m_maxAppliedImpulseMultiDof;
  static constexpr auto kDamping = &SphericalMotorFields::m_damping;
};

struct SphericalLimitFields : btMultiBodySphericalJointLimit {
  static constexpr auto kX = &SphericalLimitFields::m_swingxRange;
  static constexpr auto kY = &SphericalLimitFields::m_swingyRange;
  static constexpr auto kTwist = &SphericalLimitFields::m_twistRange;
};

struct PointFields : btMultiBodyPoint2Point {
  static constexpr auto kRigidB = &PointFields::m_rigidBodyB;
  static constexpr auto kPivotA = &PointFields::m_pivotInA;
};

struct FixedFields : btMultiBodyFixedConstraint {
  static constexpr auto kRigidB = &FixedFields::m_rigidBodyB;
};

struct SliderFields : btMultiBodySliderConstraint {
  static constexpr auto kRigidB = &SliderFields::m_rigidBodyB;
};

}  // namespace tandem
