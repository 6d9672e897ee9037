#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include "joints/joint_settings.h"

namespace tandem {

/// True for exactly the types of Bullet 3.24: point to point, hinge, hinge with accumulated angle,
/// slider, cone twist, 6-dof, universal, 6-dof spring, 6-dof spring 2, hinge 2, fixed and gear. A
/// derived type may compute other rows, so it is unknown.
[[nodiscard]] bool isKnownJoint(const btTypedConstraint& host) noexcept;

/// Reads a joint of a known type. `host` is not const as Bullet's getters are not; they write
/// nothing. Neither allocates nor throws.
[[nodiscard]] JointSettings readJoint(btTypedConstraint& host, const HostSolver& solver) noexcept;

}  // namespace tandem
