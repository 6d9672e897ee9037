#pragma once

#include <optional>

#include "tandem/coordination/shape.h"

class btCollisionShape;
class btRigidBody;

#pragma GCC visibility push(default)
namespace tandem {

/// Converts a Bullet shape to the island's form where that is exact: box, sphere, capsule,
/// cylinder, cone, static plane, equal spheres, and everything that is the hull of some points. The
/// rounding of a hull or cone is Bullet's margin. A shape without volume (a triangle, a flat hull
/// or box) is made 1e-4 of its size thick to either side, within its margin if there is one. An
/// oval cylinder is round, as Bullet collides it.
///
/// A compound of one child at its origin counts as the child, because some hosts wrap every shape.
/// So does a 2-D or scaled shape. Other compounds, nested or GImpact's too, become a Compound of
/// the forms that findForm() gives their children; nothing if a child has none or is a plane.
/// Children without a surface (btEmptyShape) do not count. Nothing for other shapes: those of
/// sampleShape() and convertMesh(). Allocates; a hull of 4000 points takes some milliseconds.
[[nodiscard]] std::optional<Shape> convertShape(const btCollisionShape& shape);

/// Hull of samples of any convex shape, for those that have no exact form: unequal spheres,
/// Minkowski sums, shapes of the host's own. It takes 600 points at most, or fewer if the surface
/// is within 2e-4 of the shape's size. Takes some milliseconds. Nothing for a shape that is not
/// convex.
[[nodiscard]] std::optional<Shape> sampleShape(const btCollisionShape& shape);

/// Converts a triangle shape (any concave shape that tells its triangles, height fields too) to a
/// surface whose skin is Bullet's margin. Nothing for another shape or a mesh without an area. Not
/// in the tick: it takes some microseconds per triangle.
///
/// The island's triangles are one-sided: their corners run counter-clockwise seen from the free
/// side. A height field is free above, on the positive side of its up axis.
[[nodiscard]] std::optional<Shape> convertMesh(const btCollisionShape& shape);

/// The island's form of any shape: that of convertShape(), else sampleShape(), else convertMesh().
/// Nothing for an empty shape, a signed distance field, a soft body. As slow as these.
[[nodiscard]] std::optional<Shape> findForm(const btCollisionShape& shape);

/// Form of a body's shape if a body with it can be shared; see getShareableShape().
[[nodiscard]] std::optional<Shape> findShareableShape(const btRigidBody& body);

/// Shape of a body that can be shared: that of any convex shape, or of a compound of shapes that
/// all have a form. Throws tandem::Error that names any other shape.
[[nodiscard]] Shape getShareableShape(const btRigidBody& body);

}  // namespace tandem
#pragma GCC visibility pop
