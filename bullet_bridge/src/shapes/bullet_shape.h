#pragma once

#include <memory>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include "tandem/coordination/shape.h"

namespace tandem {

/// Bullet's form of a shape, a hull with its rounding as margin: the inverse of convertShape().
/// Throws std::invalid_argument for a mesh. `shape` must be as checkShape() wants it.
[[nodiscard]] std::unique_ptr<btCollisionShape> makeBulletShape(const Shape& shape);

}  // namespace tandem
