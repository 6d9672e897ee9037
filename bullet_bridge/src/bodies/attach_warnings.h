#pragma once

#include <string>
#include <vector>

#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace tandem {

/// True if the body was built with m_additionalDamping, for which Bullet has no getter: a slow body
/// is asked to damp itself. Linear and angular damping must be 0. Leaves the body as it was.
[[nodiscard]] bool hasAdditionalDamping(btRigidBody& body);

/// What a user should know about a body that the island is going to move, one line each.
[[nodiscard]] std::vector<std::string> describeSurprises(const btRigidBody& body,
                                                         btScalar linear_damping,
                                                         btScalar angular_damping,
                                                         bool has_additional_damping);

}  // namespace tandem
