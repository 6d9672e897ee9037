#pragma once

#include <variant>

#include "tandem/coordination/types.h"

namespace tandem {

/// Ball around the body's origin.
struct Sphere {
  double radius = 0.0;  ///< [m], > 0
};

/// Box around the body's origin, edges along the body's axes.
struct Box {
  Vec3 half_extents = Vec3::Zero();  ///< [m], each > 0
};

/// Segment along the body's y axis (as Bullet's btCapsuleShape), fattened by a radius.
struct Capsule {
  double radius = 0.0;       ///< [m], > 0
  double half_length = 0.0;  ///< half of the segment [m], >= 0
};

/// Half-space `normal_B . p <= offset` of the body's frame; solid below, free above.
struct Plane {
  Vec3 normal_B = Vec3::UnitY();  ///< unit vector out of the solid
  double offset = 0.0;            ///< [m]
};

using Shape = std::variant<Sphere, Box, Capsule, Plane>;

/// Radius of a ball around the body's origin that holds the shape [m]; infinite for a plane.
[[nodiscard]] double computeBoundingRadius(const Shape& shape) noexcept;

/// Throws std::invalid_argument, naming the value, unless all sizes are finite and as documented.
void checkShape(const Shape& shape);

}  // namespace tandem
