#pragma once

#include <memory>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>

namespace tandem {

/// Bullet finds no contact of two boxes across a gap. Boxes at rest on each other open and close by
/// rounding. Their copies are larger by this, and distances are corrected [m]. It is far above an
/// inner step's motion at rest, g h^2 = 6e-7, and negligible at a corner.
inline constexpr btScalar kBoxSkin = btScalar(5e-6);

/// Copies a convex shape or a plane with all its data, because the host may delete it while the
/// haptic thread still searches. Boxes grow by `skin` all round. Null for other shapes, and for
/// convex classes of the host's own.
[[nodiscard]] std::unique_ptr<btCollisionShape> copyShape(const btCollisionShape& shape,
                                                          btScalar skin = 0);

}  // namespace tandem
