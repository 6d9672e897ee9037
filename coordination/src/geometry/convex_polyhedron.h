#pragma once

#include <vector>

#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

/// A convex solid with flat faces, in its body's frame. Immutable; a ConvexHull refers to it.
class ConvexPolyhedron {
 public:
  /// One side of a face. Seen from outside, a face's sides run counter-clockwise.
  struct Side {
    Vec3 start = Vec3::Zero();    ///< [m]
    Vec3 along = Vec3::Zero();    ///< unit vector towards the next corner
    Vec3 outward = Vec3::Zero();  ///< unit vector in the face's plane, out of the face
    double length = 0.0;          ///< [m]
  };
  /// A face with its outward normal: `normal . p <= offset` holds in the solid. Its sides are
  /// [first, first + count).
  struct Face {
    Vec3 normal = Vec3::UnitX();
    double offset = 0.0;
    int first = 0, count = 0;
  };

  /// `faces` lists the corners of each face as indices into `vertices`, counter-clockwise seen from
  /// outside. Sides shorter than 1e-12 of the size are dropped. Throws std::invalid_argument for
  /// non-finite values, fewer than four faces, or a face without area or with fewer than three
  /// corners. Also throws unless the solid is closed and convex within 1e-6 of its size.
  ConvexPolyhedron(std::vector<Vec3> vertices, const std::vector<std::vector<int>>& faces);

  /// Convex hull of the points, with triangular faces. Points within 1e-7 of the size from its
  /// surface become no corners. Throws std::invalid_argument if the points are not finite or lie in
  /// one plane.
  [[nodiscard]] static ConvexPolyhedron makeHull(const std::vector<Vec3>& points);

  [[nodiscard]] const std::vector<Vec3>& vertices() const noexcept { return vertices_; }
  [[nodiscard]] const std::vector<Face>& faces() const noexcept { return faces_; }
  [[nodiscard]] const Side* sides(const Face& face) const noexcept {
    return sides_.data() + face.first;
  }
  /// Radius of the sphere around the body's origin that holds the solid [m].
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
