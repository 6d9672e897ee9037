#pragma once

#include "tandem/coordination/types.h"

namespace tandem::pybullet {

/// Gyroscopic law of an engine for free bodies. PyBullet has no switch for it.
enum class GyroLaw {
  kExplicit,  // btMultiBody: Euler's equation at the start of the step
  kImplicit,  // btRigidBody: one Newton step of implicit Euler, in the body's frame
};

/// Angular velocity after a step of `dt` [s] for a free body with `w_W` [rad/s]. `inertia`:
/// principal moments [kg m^2]; `R_WB`: orientation. Pure.
[[nodiscard]] Vec3 applyGyroLaw(GyroLaw law, const Vec3& inertia, const Quat& R_WB, const Vec3& w_W,
                                double dt);

/// Angular velocity that applyGyroLaw() turns into `target_W` [rad/s], or near it if one step turns
/// the body by a radian or more. It is the target itself if all principal moments are equal. Pure;
/// bounded time.
[[nodiscard]] Vec3 computeVelocityBefore(GyroLaw law, const Vec3& inertia, const Quat& R_WB,
                                         const Vec3& target_W, double dt);

}  // namespace tandem::pybullet
