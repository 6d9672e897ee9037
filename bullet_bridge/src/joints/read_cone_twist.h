#pragma once

#include <BulletDynamics/ConstraintSolver/btConeTwistConstraint.h>

#include "joints/joint_settings.h"

namespace tandem {

/// Reads a cone twist joint: its pin, twist (axis 3) and cone (axes 4 and 5).
void readConeTwist(btConeTwistConstraint& host, const HostSolver& solver, JointSettings& joint);

}  // namespace tandem
