#pragma once

#include <optional>

#include "tandem/coordination/shape.h"

class btCollisionShape;
class btRigidBody;

namespace tandem {

/// The island's own form of a Bullet shape: box, sphere, capsule along y, static plane, each with
/// Bullet's margin where it counts. Nothing for a shape that the island does not know.
[[nodiscard]] std::optional<Shape> convertShape(const btCollisionShape& shape);

/// The shape of a body that can be shared: box, sphere or capsule. Throws tandem::Error naming any
/// other.
[[nodiscard]] Shape getShareableShape(const btRigidBody& body);

}  // namespace tandem
