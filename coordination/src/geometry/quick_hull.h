#pragma once

#include <array>
#include <optional>
#include <vector>

#include "geometry/plain_vec.h"

namespace tandem {

/// A triangle of a convex hull.
struct HullTriangle {
  std::array<int, 3> corners{};  ///< points, counter-clockwise seen from outside
  std::array<int, 3> beyond{};   ///< triangle at the side from corner k to corner k + 1
  PlainVec normal;               ///< outward
  double offset = 0.0;           ///< normal . p of its corners [m]

  /// Height of a point over its plane [m].
  [[nodiscard]] double height(const Vec3& p) const noexcept {
    return dot(normal, PlainVec(p)) - offset;
  }
};

/// A closed surface of triangles around points.
struct HullTriangles {
  std::vector<HullTriangle> triangles;
  double on_face = 0.0;        ///< points nearer to a face are on it [m]
  bool has_left_some = false;  ///< rounding kept out some points, by less than 10 on_face
};

/// Convex hull of at least four points. Those within `precision` of its surface, a share of their
/// size, become no corners. Nothing if rounding keeps the surface open. Throws
/// std::invalid_argument if the points are not finite or lie in one plane. Time grows as n log n.
[[nodiscard]] std::optional<HullTriangles> makeHullTriangles(const std::vector<Vec3>& points,
                                                             double precision);

}  // namespace tandem
