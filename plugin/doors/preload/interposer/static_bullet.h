#pragma once

namespace tandem::preload {

/// The file of a loaded program or library, other than a libBulletDynamics, that has a Bullet of
/// its own linked in: its symbols are bound already, so nobody can come between. Empty name: the
/// program itself; null: none. Found by the name that C++ keeps of a class with virtual functions;
/// a Bullet without RTTI is not found.
[[nodiscard]] const char* findStaticBullet() noexcept;

}  // namespace tandem::preload
