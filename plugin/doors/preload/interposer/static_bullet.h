#pragma once

namespace tandem::preload {

/// File name of a loaded program or library with Bullet linked in statically, other than a
/// libBulletDynamics. Its symbols are bound already and cannot be intercepted. An empty name is the
/// program itself; null is none. Found by the RTTI name of a class; a Bullet without RTTI is not
/// found.
[[nodiscard]] const char* findStaticBullet() noexcept;

}  // namespace tandem::preload
