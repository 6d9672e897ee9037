#pragma once

#include "host_bullet.h"
#include "preload/adaptor_door.h"

namespace tandem::preload {

/// A world was made: if the config wants it, the adaptor for its width takes it over from here.
/// Loads that adaptor with the first world of the process. Thread safe.
void offerWorld(void* world, const HostBullet& bullet) noexcept;

/// The adaptor if it has taken this world, else null. One comparison.
[[nodiscard]] const TandemPreloadDoor* adaptorOf(const void* world) noexcept;

/// A world ends. If the adaptor has it, it lets go now, while the world is still whole as a
/// btDiscreteDynamicsWorld.
void endWorld(void* world, const HostBullet& bullet) noexcept;

/// What can be said of the process before it runs, and at its end.
void lookAtProgram() noexcept;
void sayIfNothingCame() noexcept;

}  // namespace tandem::preload
