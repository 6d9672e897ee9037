#pragma once

#include <optional>

#include "tandem/coordination/shape.h"

class btCollisionShape;
class btRigidBody;

#pragma GCC visibility push(default)
namespace tandem {

/// The island's own form of a Bullet shape: box, sphere, capsule, cylinder, convex hull, static
/// plane, each with Bullet's margin where it counts: hulls are rounded by it. A compound of one
/// child at its origin is that child, as some hosts wrap every shape so. Nothing for a shape that
/// the island does not know: cylinders scaled to ovals, hulls without a volume, concave shapes,
/// other compounds and others. Allocates, and for a hull takes time that grows with the square of
/// its points.
[[nodiscard]] std::optional<Shape> convertShape(const btCollisionShape& shape);

/// The surface of a shape made of triangles (mesh, scaled mesh, height field), its skin Bullet's
/// margin. Nothing for another shape, or a mesh without an area. Not in the tick: some microseconds
/// for each triangle.
///
/// The island's triangles are one-sided, as those of a closed mesh: their corners run
/// counter-clockwise seen from the free side. A height field is free above, on the positive side of
/// its up axis.
[[nodiscard]] std::optional<Shape> convertMesh(const btCollisionShape& shape);

/// The shape of a body that can be shared: box, sphere, capsule, cylinder or convex hull, or a
/// compound of one of them at its origin. Throws tandem::Error naming any other.
[[nodiscard]] Shape getShareableShape(const btRigidBody& body);

}  // namespace tandem
#pragma GCC visibility pop
