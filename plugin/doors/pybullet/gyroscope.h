#pragma once

#include "tandem/coordination/types.h"

namespace tandem::pybullet {

/// How an engine lets a free body turn, which PyBullet offers no switch for.
enum class GyroLaw {
  kExplicit,  // btMultiBody: Euler's equation at the start of the step
  kImplicit,  // btRigidBody: one Newton step of implicit Euler, in the body's frame
};

/// What the engine makes of the angular velocity `w_W` [rad/s] of a free body in a step of `dt`
/// [s]. `inertia`: principal moments [kg m^2]; `R_WB`: its orientation. Pure.
[[nodiscard]] Vec3 applyGyroLaw(GyroLaw law, const Vec3& inertia, const Quat& R_WB, const Vec3& w_W,
                                double dt);

/// The angular velocity to give the engine so that `target_W` [rad/s] comes out of applyGyroLaw().
/// The target itself for a body that turns evenly about all axes. Pure; bounded time.
[[nodiscard]] Vec3 computeVelocityBefore(GyroLaw law, const Vec3& inertia, const Quat& R_WB,
                                         const Vec3& target_W, double dt);

}  // namespace tandem::pybullet
