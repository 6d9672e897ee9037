#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace tandem {

/// Weight that Bullet stores for the body, in W and without its linear factor; Bullet has no
/// getter. The body stays unchanged.
[[nodiscard]] btVector3 measureWeight(btRigidBody& body) noexcept;

/// Restores inverse mass and inverse inertia to the bit. Restores the weight too if it fits them
/// and the body's present gravity; else the weight becomes that of setGravity().
void restoreMass(btRigidBody& body, btScalar inverse_mass, const btVector3& inverse_inertia,
                 const btVector3& weight) noexcept;

}  // namespace tandem
