#pragma once

#include "host_bullet.h"
#include "preload/adaptor_door.h"

namespace tandem::preload {

/// Offers a new world to the adaptor, which takes it if the config wants it. Loads the adaptor with
/// the first world of the process. Thread safe.
void offerWorld(void* world, const HostBullet& bullet) noexcept;

/// Adaptor of this world; null if it is not shared. One comparison.
[[nodiscard]] const TandemPreloadDoor* adaptorOf(const void* world) noexcept;

/// Tells the adaptor that a world of its ends, while the world is still a complete
/// btDiscreteDynamicsWorld.
void endWorld(void* world, const HostBullet& bullet) noexcept;

/// Reports at the start and at the end of the process.
void lookAtProgram() noexcept;
void sayIfNothingCame() noexcept;

}  // namespace tandem::preload
