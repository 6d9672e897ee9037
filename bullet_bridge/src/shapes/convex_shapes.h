#pragma once

#include <optional>

#include "tandem/coordination/shape.h"

class btConvexShape;
class btMultiSphereShape;
class btPolyhedralConvexShape;

namespace tandem {

/// Hull of the corners that Bullet tells of a shape; its rounding is Bullet's margin.
[[nodiscard]] std::optional<Shape> convertCorners(const btPolyhedralConvexShape& shape);

/// Exact form of equal spheres that are scaled equally in all directions: the hull of their centres
/// with their radius as rounding. Nothing for others.
[[nodiscard]] std::optional<Shape> convertEqualSpheres(const btMultiSphereShape& spheres);

/// Hull of samples of any convex shape.
[[nodiscard]] std::optional<Shape> sampleConvex(const btConvexShape& shape);

/// The shape `factor` times as large. Nothing for shapes that are not convex solids.
[[nodiscard]] std::optional<Shape> scaleShape(const Shape& shape, double factor);

}  // namespace tandem
