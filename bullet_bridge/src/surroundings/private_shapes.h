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

/// Factor of enlarge(), and of the poses that go with it: exact in float.
inline constexpr btScalar kEnlarged = sizeof(btScalar) == 4 ? btScalar(64) : btScalar(1);

/// A float Bullet's search for the nearest points of two convex shapes ends at about a millimetre:
/// between a peg of 20 mm and a wall 9 mm wide it was 1.4 mm wrong. 64 times as large it is right
/// to a micrometre. Refers to `own`, and takes its size. Null in double, and for shapes that are
/// not convex.
[[nodiscard]] std::unique_ptr<btCollisionShape> enlarge(btCollisionShape& own);

/// True if Bullet searches for the nearest points of the two: there is no better way.
[[nodiscard]] bool needsNearestPoints(const btCollisionShape& a,
                                      const btCollisionShape& b) noexcept;

}  // namespace tandem
