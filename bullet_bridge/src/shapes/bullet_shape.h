#pragma once

#include <memory>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include "tandem/coordination/shape.h"

namespace tandem {

/// Converts a shape to Bullet's form, the inverse of convertShape(). The margin of a hull or cone
/// is its rounding. A compound owns its children. Throws std::invalid_argument for a mesh. `shape`
/// must satisfy checkShape().
[[nodiscard]] std::unique_ptr<btCollisionShape> makeBulletShape(const Shape& shape);

}  // namespace tandem
