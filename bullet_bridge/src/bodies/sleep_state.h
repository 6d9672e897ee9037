#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace tandem {

/// True for an activation state in which Bullet has a body asleep, or is about to.
[[nodiscard]] inline bool mayFallAsleep(int activation_state) noexcept {
  return activation_state == ISLAND_SLEEPING || activation_state == WANTS_DEACTIVATION;
}

inline void wake(btRigidBody& body) noexcept {
  body.forceActivationState(ACTIVE_TAG);
  body.setDeactivationTime(0);
}

}  // namespace tandem
