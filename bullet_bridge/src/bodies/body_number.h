#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

#pragma GCC visibility push(default)
namespace tandem {

/// Number that Bullet gives a body when it is constructed. No two bodies of the process have the
/// same, wherever they are in memory. Stands in the body. Real-time safe.
[[nodiscard]] const int& numberOf(const btRigidBody& body) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
