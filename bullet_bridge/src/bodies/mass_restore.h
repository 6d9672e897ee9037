#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace tandem {

/// The weight that Bullet keeps for the body, in W and without its linear factor; there is no
/// getter. Leaves the body as it was.
[[nodiscard]] btVector3 measureWeight(btRigidBody& body) noexcept;

/// Gives the body this inverse mass and inverse inertia to the bit, and this weight too if that
/// belongs to them and the body's present gravity; else the weight that setGravity() computes.
void restoreMass(btRigidBody& body, btScalar inverse_mass, const btVector3& inverse_inertia,
                 const btVector3& weight) noexcept;

}  // namespace tandem
