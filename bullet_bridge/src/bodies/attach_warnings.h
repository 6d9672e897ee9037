#pragma once

#include <string>
#include <vector>

#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace tandem {

/// True if the body was built with m_additionalDamping, for which Bullet has no getter. The test
/// damps the body at a low speed and restores it. Linear and angular damping must be 0.
[[nodiscard]] bool hasAdditionalDamping(btRigidBody& body);

/// Warnings for the user about a body that the island will move, one line each.
[[nodiscard]] std::vector<std::string> describeSurprises(const btRigidBody& body,
                                                         btScalar linear_damping,
                                                         btScalar angular_damping,
                                                         bool has_additional_damping);

}  // namespace tandem
