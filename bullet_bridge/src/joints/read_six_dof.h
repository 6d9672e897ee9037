#pragma once

#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h>
#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpringConstraint.h>

#include "joints/joint_settings.h"

namespace tandem {

/// Read joints with six coordinates: three ways along the axes of frame a, three Euler angles.
void readSixDof(btGeneric6DofConstraint& host, const HostSolver& solver, JointSettings& joint);
void readSixDofSpring(btGeneric6DofSpringConstraint& host, const HostSolver& solver,
                      JointSettings& joint);
void readSixDofSpring2(btGeneric6DofSpring2Constraint& host, const HostSolver& solver,
                       JointSettings& joint);

}  // namespace tandem
