#pragma once

#include <vector>

#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

/// A convex solid with flat faces, in its body's frame. Made once; a ConvexHull refers to it.
class ConvexPolyhedron {
 public:
  /// One side of a face. Seen from outside, a face's sides run counter-clockwise.
  struct Side {
    Vec3 start = Vec3::Zero();    ///< [m]
    Vec3 along = Vec3::Zero();    ///< unit vector towards the next corner
    Vec3 outward = Vec3::Zero();  ///< unit vector in the face's plane, out of the face
    double length = 0.0;          ///< [m]
  };
  /// Solid below `normal . p <= offset`; sides [first, first + count).
  struct Face {
    Vec3 normal = Vec3::UnitX();
    double offset = 0.0;
    int first = 0, count = 0;
  };

  /// `faces` has the corners of each face as places in `vertices`, counter-clockwise seen from
  /// outside. Sides shorter than a 1e-12th of the size are left out. Throws std::invalid_argument
  /// for values that are not finite, fewer than four faces, a face of fewer than three corners or
  /// without area, or what is no closed convex solid within 1e-6 of its size.
  ConvexPolyhedron(std::vector<Vec3> vertices, const std::vector<std::vector<int>>& faces);

  /// The smallest convex solid that holds all points, its faces cut into triangles. Points within a
  /// 1e-7th of the size of its surface make no corner. Throws std::invalid_argument if the points
  /// are not finite or lie in one plane.
  [[nodiscard]] static ConvexPolyhedron makeHull(const std::vector<Vec3>& points);

  [[nodiscard]] const std::vector<Vec3>& vertices() const noexcept { return vertices_; }
  [[nodiscard]] const std::vector<Face>& faces() const noexcept { return faces_; }
  [[nodiscard]] const Side* sides(const Face& face) const noexcept {
    return sides_.data() + face.first;
  }
  /// Of a ball around the body's origin that holds it [m].
  [[nodiscard]] double boundingRadius() const noexcept { return bounding_radius_; }

 private:
  void addFace(const std::vector<int>& corners, double size);
  void checkClosed(const std::vector<std::vector<int>>& faces) const;

  std::vector<Vec3> vertices_;
  std::vector<Face> faces_;
  std::vector<Side> sides_;
  double bounding_radius_ = 0.0;
};

}  // namespace tandem
#pragma GCC visibility pop
