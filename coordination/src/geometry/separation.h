#pragma once

#include <algorithm>
#include <cmath>

#include "tandem/coordination/shape.h"

#include "geometry/plain_vec.h"
#include "geometry/triangle_mesh.h"

// clang-format off
/// \file
/// Signed distance from a centre c to a shape's surface, and the direction out of the shape. Both
/// are in the body's frame:
///
///         shape          sphere
///      +---------+
///      |         |  distance = gap + radius
///      |         p---------+-----c          p = c - distance n
///      |         |   gap     radius
///      +---------+   n ->
// clang-format on
namespace tandem {

/// Signed distance of a centre to a surface [m], negative inside, and the unit direction out.
struct Separation {
  double distance = 0.0;
  PlainVec n;
  /// The face through which an inside centre leaves: of a box 2 axis + (side < 0), of a cylinder a
  /// LeaveCylinder, of a cone a LeaveCone, of a hull an index into faces(). For a piece of a mesh:
  /// its MeshFeature, inside or outside.
  int face = -1;
  /// For a piece of a mesh: lower bound of the distance to where it pushes [m]; <= 0 if it pushes.
  double aside = 0.0;
  /// `face`, or the face right under an outside centre; -1 if there is none, or for a mesh.
  int under = face;
};

namespace detail {

/// A centre nearer to a core than this is on it [m]; rounding then hides the direction.
inline constexpr double kOnCore = 1e-12;

/// Squares below this lost digits to underflow and give no direction.
inline constexpr double kSmallestSquare = 1e-290;

/// Separation from a core point with a thickness of `radius`; `offset` leads from it to the centre.
inline Separation separateFromCore(const PlainVec& offset, double radius) noexcept {
  const double length = std::sqrt(dot(offset, offset));
  // x is perpendicular to a capsule's core, so this is a shortest way out.
  if (length < kOnCore) return {length - radius, {1.0, 0.0, 0.0}};
  return {length - radius, offset / length};
}

/// Permutes the components so that `axis` becomes y; layBack() reverses it.
inline PlainVec layAlongY(const PlainVec& v, Axis axis) noexcept {
  if (axis == Axis::kX) return {v.z, v.x, v.y};
  return axis == Axis::kZ ? PlainVec{v.y, v.z, v.x} : v;
}
inline PlainVec layBack(const PlainVec& v, Axis axis) noexcept {
  if (axis == Axis::kX) return {v.y, v.z, v.x};
  return axis == Axis::kZ ? PlainVec{v.z, v.x, v.y} : v;
}

/// Separation of a centre from one face of a box, wherever the centre is.
inline Separation leaveByFace(const PlainVec& c, const Vec3& half_extents, int face) noexcept {
  const double side = (face & 1) != 0 ? -1.0 : 1.0;
  switch (face >> 1) {
    case 0:
      return {side * c.x - half_extents.x(), {side, 0.0, 0.0}, face};
    case 1:
      return {side * c.y - half_extents.y(), {0.0, side, 0.0}, face};
    default:
      return {side * c.z - half_extents.z(), {0.0, 0.0, side}, face};
  }
}

/// Separation through the nearest face, for a centre inside a box or on its surface.
inline Separation leaveBox(const PlainVec& c, const Vec3& half_extents) noexcept {
  const double depth_x = half_extents.x() - std::abs(c.x);
  const double depth_y = half_extents.y() - std::abs(c.y);
  const double depth_z = half_extents.z() - std::abs(c.z);
  if (depth_x <= depth_y && depth_x <= depth_z) return leaveByFace(c, half_extents, c.x < 0.0);
  if (depth_y <= depth_z) return leaveByFace(c, half_extents, 2 + (c.y < 0.0));
  return leaveByFace(c, half_extents, 4 + (c.z < 0.0));
}

}  // namespace detail

inline Separation separate(const PlainVec& c, const Sphere& sphere) noexcept {
  return detail::separateFromCore(c, sphere.radius);
}

inline Separation separate(const PlainVec& c, const Capsule& capsule) noexcept {
  if (capsule.axis != Axis::kY) {
    Separation found =
        separate(detail::layAlongY(c, capsule.axis), Capsule{capsule.radius, capsule.half_length});
    found.n = detail::layBack(found.n, capsule.axis);
    return found;
  }
  const double core_y = std::clamp(c.y, -capsule.half_length, capsule.half_length);
  return detail::separateFromCore({c.x, c.y - core_y, c.z}, capsule.radius);
}

[[nodiscard]] Separation separate(const PlainVec& c, const Cylinder& cylinder) noexcept;
[[nodiscard]] Separation separate(const PlainVec& c, const Cone& cone) noexcept;
[[nodiscard]] Separation separate(const PlainVec& c, const ConvexHull& hull) noexcept;
/// Separation from the nearest point of a whole mesh; its piece there decides the sign.
[[nodiscard]] Separation separate(const PlainVec& c, const Mesh& mesh) noexcept;

/// Separation from the nearest part. Only a part alone knows its faces: none is told.
[[nodiscard]] Separation separate(const PlainVec& c, const Compound& compound) noexcept;

inline Separation separate(const PlainVec& c, const Box& box) noexcept {
  const Vec3& h = box.half_extents;
  const PlainVec outwards{c.x - std::clamp(c.x, -h.x(), h.x()),  //
                          c.y - std::clamp(c.y, -h.y(), h.y()),
                          c.z - std::clamp(c.z, -h.z(), h.z())};
  // Over a face, the usual case: no square root, no division, an exact normal.
  const auto over_face = [](double way, const PlainVec& n, int face) noexcept {
    return way < 0.0 ? Separation{-way, {-n.x, -n.y, -n.z}, -1, 0.0, face + 1}
                     : Separation{way, n, -1, 0.0, face};
  };
  const bool over_x = outwards.x != 0.0, over_y = outwards.y != 0.0, over_z = outwards.z != 0.0;
  if (over_x && !over_y && !over_z) return over_face(outwards.x, {1.0, 0.0, 0.0}, 0);
  if (!over_x && over_y && !over_z) return over_face(outwards.y, {0.0, 1.0, 0.0}, 2);
  if (!over_x && !over_y && over_z) return over_face(outwards.z, {0.0, 0.0, 1.0}, 4);
  const double square = dot(outwards, outwards);
  if (square < detail::kSmallestSquare) return detail::leaveBox(c, h);
  const double distance = std::sqrt(square);
  return {distance, outwards / distance};
}

/// How much nearer this face is than any other to a centre inside the box [m]. Negative: the centre
/// leaves through another face.
inline double computeFaceLead(const PlainVec& c, const Box& box, int face) noexcept {
  const Vec3& h = box.half_extents;
  const double depth[] = {h.x() - std::abs(c.x), h.y() - std::abs(c.y), h.z() - std::abs(c.z)};
  const int axis = face >> 1;
  const double others = std::min(depth[(axis + 1) % 3], depth[(axis + 2) % 3]);
  const double own = -detail::leaveByFace(c, h, face).distance;
  // The centre left through this face, which stays nearest while the centre is over it.
  return own > 0.0 ? std::min(others, 2.0 * h[axis] - own) - own : others;
}

inline Separation separate(const PlainVec& c, const Plane& plane) noexcept {
  // The normal is unit only within checkShape's tolerance; dividing keeps the half-space the same.
  const PlainVec n(plane.normal_B);
  const double length = std::sqrt(dot(n, n));
  return {(dot(n, c) - plane.offset) / length, n / length};
}

inline Separation separate(const PlainVec& c, const Shape& shape) noexcept {
  return std::visit([&c](const auto& s) noexcept { return separate(c, s); }, shape);
}

/// Faces through which a centre inside a cylinder leaves.
enum LeaveCylinder { kSide, kUpperEnd, kLowerEnd };
/// Faces through which a centre inside a cone leaves.
enum LeaveCone { kConeSide, kConeBase };

/// Separation from one face, wherever the centre is; see computeFaceLead().
[[nodiscard]] Separation leaveByFace(const PlainVec& c, const Cylinder& cylinder,
                                     int face) noexcept;
[[nodiscard]] Separation leaveByFace(const PlainVec& c, const Cone& cone, int face) noexcept;
[[nodiscard]] Separation leaveByFace(const PlainVec& c, const ConvexHull& hull, int face) noexcept;
[[nodiscard]] double computeFaceLead(const PlainVec& c, const Cylinder& cylinder,
                                     int face) noexcept;
[[nodiscard]] double computeFaceLead(const PlainVec& c, const Cone& cone, int face) noexcept;
[[nodiscard]] double computeFaceLead(const PlainVec& c, const ConvexHull& hull, int face) noexcept;

/// True if the centre's foot on the plane or cone of a face is beside the face.
[[nodiscard]] bool isBesideFace(const PlainVec& c, const Cone& cone, int face) noexcept;

/// Separation from the feature of one mesh triangle (by its index) that pushes a centre at c. If
/// none pushes, the separation from its face, with `aside` above 0. `touched`: the triangle that
/// the sphere has touched, or -1; see held_face.h.
[[nodiscard]] Separation separate(const PlainVec& c, const Mesh& mesh, int piece,
                                  int touched) noexcept;
[[nodiscard]] Separation leaveByFace(const PlainVec& c, const Mesh& mesh, int piece,
                                     int feature) noexcept;
[[nodiscard]] double computeFaceLead(const PlainVec& c, const Mesh& mesh, int piece, int feature,
                                     int touched) noexcept;

/// Generic forms for any shape with faces; `piece` matters for a mesh only. `touched`: the face
/// that the sphere has touched, or -1.
[[nodiscard]] Separation leaveAnyByFace(const PlainVec& c, const Shape& shape, int piece,
                                        int face) noexcept;
[[nodiscard]] double computeAnyFaceLead(const PlainVec& c, const Shape& shape, int piece, int face,
                                        int touched) noexcept;

}  // namespace tandem
