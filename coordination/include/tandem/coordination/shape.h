#pragma once

#include <cstdint>
#include <memory>
#include <variant>

#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

class CompoundParts;
class ConvexPolyhedron;
class TriangleMesh;

/// Ball around the body's origin.
struct Sphere {
  double radius = 0.0;  ///< [m], > 0
};

/// Box around the body's origin, edges along the body's axes.
struct Box {
  Vec3 half_extents = Vec3::Zero();  ///< [m], each > 0
};

/// An axis of a body's frame.
enum class Axis : std::uint8_t { kX, kY, kZ };

/// Segment along an axis through the body's origin, thickened by a radius.
struct Capsule {
  double radius = 0.0;       ///< [m], > 0
  double half_length = 0.0;  ///< half of the segment [m], >= 0
  Axis axis = Axis::kY;
};

/// Cylinder around the body's origin.
struct Cylinder {
  double radius = 0.0;       ///< [m], > 0
  double half_length = 0.0;  ///< [m], > 0
  Axis axis = Axis::kY;
};

/// Cone with its base half a length down the axis from the body's origin and its tip half a length
/// up. It is thickened all round by a rounding (Bullet's collision margin).
struct Cone {
  double radius = 0.0;       ///< of the base [m], > 0
  double half_length = 0.0;  ///< half of the height [m], > 0
  Axis axis = Axis::kY;
  double rounding = 0.0;  ///< [m], >= 0
};

/// A convex solid, thickened all round by a rounding (Bullet's collision margin). Copies share the
/// immutable solid, so copying allocates nothing. Destroying the last copy frees it: keep one copy
/// outside the tick.
struct ConvexHull {
  std::shared_ptr<const ConvexPolyhedron> solid;  ///< not null
  double rounding = 0.0;                          ///< [m], >= 0
};

/// Half-space `normal_B . p <= offset` in the body's frame; solid below, free above.
struct Plane {
  Vec3 normal_B = Vec3::UnitY();  ///< unit vector out of the solid
  double offset = 0.0;            ///< [m]
};

/// A triangle surface, thickened by a skin on its outer side; for obstacles and parts of compounds.
/// Copies share the surface, as with ConvexHull.
struct Mesh {
  std::shared_ptr<const TriangleMesh> surface;  ///< not null
  double skin = 0.0;                            ///< [m], >= 0
};

/// Several shapes at fixed poses in one body. They may overlap, and each pushes by itself, as
/// separate bodies do. Copies share the parts, as with ConvexHull.
struct Compound {
  std::shared_ptr<const CompoundParts> parts;  ///< not null
};

using Shape = std::variant<Sphere, Box, Capsule, Plane, Cylinder, ConvexHull, Mesh, Cone, Compound>;

/// Radius of the sphere around the body's origin that holds the shape [m]; infinite for a plane.
[[nodiscard]] double computeBoundingRadius(const Shape& shape) noexcept;

/// Extent of the shape from its origin along a direction of the body [m]; infinite for a plane.
[[nodiscard]] double computeReach(const Shape& shape, const Vec3& direction_B) noexcept;

/// Throws std::invalid_argument, naming the value, unless all sizes are finite and in range.
void checkShape(const Shape& shape);

}  // namespace tandem
#pragma GCC visibility pop
