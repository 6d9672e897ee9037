#pragma once

#include <optional>

#include "tandem/coordination/shape.h"

class btCollisionShape;
class btRigidBody;

#pragma GCC visibility push(default)
namespace tandem {

/// Converts a Bullet shape to the island's form: box, sphere, capsule, cylinder, convex hull or
/// static plane. A hull's rounding is Bullet's margin. A compound of one child at its origin counts
/// as the child, because some hosts wrap every shape. Nothing for other shapes: oval cylinders,
/// hulls without a volume, concave shapes, other compounds. Allocates; the time for a hull grows
/// with the square of its points.
[[nodiscard]] std::optional<Shape> convertShape(const btCollisionShape& shape);

/// Converts a triangle shape (mesh, scaled mesh, height field) to a surface whose skin is Bullet's
/// margin. Nothing for another shape or a mesh without an area. Not in the tick: it takes some
/// microseconds per triangle.
///
/// The island's triangles are one-sided: their corners run counter-clockwise seen from the free
/// side. A height field is free above, on the positive side of its up axis.
[[nodiscard]] std::optional<Shape> convertMesh(const btCollisionShape& shape);

/// Shape of a body that can be shared: box, sphere, capsule, cylinder or convex hull, or a compound
/// of one of them at its origin. Throws tandem::Error that names any other shape.
[[nodiscard]] Shape getShareableShape(const btRigidBody& body);

}  // namespace tandem
#pragma GCC visibility pop
