#pragma once

#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include "coordination/src/island/collision_filter.h"

namespace tandem {

/// Group and mask that the host gave the object. An object outside of a world has the defaults.
[[nodiscard]] inline CollisionFilter filterOf(const btCollisionObject& object) noexcept {
  const btBroadphaseProxy* proxy = object.getBroadphaseHandle();
  if (proxy == nullptr) return {};
  return {proxy->m_collisionFilterGroup, proxy->m_collisionFilterMask};
}

}  // namespace tandem
