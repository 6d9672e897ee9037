#pragma once

#include <vector>

#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

struct FaceList;

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

  /// Convex hull of the points. Each plane has one face, whatever its number of corners. Points
  /// within 1e-7 of the size from its surface become no corners; 1e-5 at most if rounding scatters
  /// them about planes. Throws std::invalid_argument if the points are not finite or lie in one
  /// plane. Time grows as n log n.
  [[nodiscard]] static ConvexPolyhedron makeHull(const std::vector<Vec3>& points);

  [[nodiscard]] const std::vector<Vec3>& vertices() const noexcept { return vertices_; }
  [[nodiscard]] const std::vector<Face>& faces() const noexcept { return faces_; }
  [[nodiscard]] const Side* sides(const Face& face) const noexcept {
    return sides_.data() + face.first;
  }
  /// Radius of the sphere around the body's origin that holds the solid [m].
  [[nodiscard]] double boundingRadius() const noexcept { return bounding_radius_; }

 private:
  /// Checks nothing: the faces must be closed and convex.
  ConvexPolyhedron(std::vector<Vec3> vertices, const FaceList& faces);
  void takeFaces(const FaceList& faces);
  void addFace(const int* corners, int count, double size);
  [[nodiscard]] double computeSize() const;
  void checkClosed(const std::vector<std::vector<int>>& faces) const;
  void checkConvex() const;

  std::vector<Vec3> vertices_;
  std::vector<Face> faces_;
  std::vector<Side> sides_;
  double bounding_radius_ = 0.0;
};

}  // namespace tandem
#pragma GCC visibility pop
