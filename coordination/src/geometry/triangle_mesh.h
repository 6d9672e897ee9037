#pragma once

#include <array>
#include <vector>

#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

/// A surface of triangles in its body's frame, for spheres to touch. Made once, outside the tick; a
/// Mesh refers to it.
///
/// Triangles are one-sided: the corners run counter-clockwise seen from the free side, and what is
/// behind is solid. A centre outside is pushed by each part of the surface that it is right over:
///
///   face           over it, as far as its edges
///   convex edge    beyond both its faces, between its ends; so do open edges
///   convex corner  beyond the ends of all its edges
///
/// so that faces in one plane push once, and the two sides of a groove both. Where two faces meet
/// at a blunt concave edge (less than 60 degrees off flat), each pushes on its side of the plane
/// between them, so that a bowl pushes once. A centre inside leaves by the nearest face, and by all
/// walls of a sharp concave edge. Behind a surface with open edges there is nothing any more at
/// kDeepest.
class TriangleMesh {
 public:
  /// How faces meet at an edge of a triangle.
  enum class Meeting : char {
    kFlat,     ///< in one plane, or blunt concave: parted by the plane between them
    kConvex,   ///< the edge pushes
    kConcave,  ///< each pushes as a plane beyond the edge, while the centre is behind the other
    kOpen,     ///< no other face
  };

  /// Edge k of a triangle, from corner k to the next.
  struct Edge {
    Vec3 start = Vec3::Zero(), end = Vec3::Zero();  ///< the same for both triangles, as `along`
    Vec3 along = Vec3::Zero();                      ///< unit vector
    Vec3 inward =
        Vec3::Zero();  ///< unit normal of the plane that parts: positive over the triangle
    Meeting meeting = Meeting::kOpen;
    bool is_owner = false;  ///< the edge pushes as a part of this triangle
    int mate = -1;          ///< the same edge of the other triangle, 3 triangle + k
  };
  struct Corner {
    Vec3 p = Vec3::Zero();
    bool is_owner = false;     ///< the corner pushes as a part of this triangle
    int first = 0, count = 0;  ///< of its directions
  };
  struct Triangle {
    Vec3 normal = Vec3::UnitX();
    double offset = 0.0;
    std::array<Edge, 3> edges;
    std::array<Corner, 3> corners;
    Vec3 middle = Vec3::Zero();
  };

  static constexpr double kDeepest = 0.1;  ///< behind an open surface a centre is pushed back [m]

  /// `corners`: three for each triangle. Corners nearer to each other than a millionth of the size
  /// are one; triangles without area are left out. Throws std::invalid_argument for values that are
  /// not finite or if none is left.
  explicit TriangleMesh(const std::vector<Vec3>& corners);

  [[nodiscard]] const std::vector<Triangle>& triangles() const noexcept { return triangles_; }
  /// Unit vectors along all edges that end in a corner, away from it.
  [[nodiscard]] const Vec3* directions(const Corner& corner) const noexcept {
    return directions_.data() + corner.first;
  }
  [[nodiscard]] bool isClosed() const noexcept { return is_closed_; }
  /// Of a ball around the body's origin that holds it [m].
  [[nodiscard]] double boundingRadius() const noexcept { return bounding_radius_; }

  /// Distance to the nearest triangle [m], or `most` if that is less. Real-time safe.
  [[nodiscard]] double findNearest(const Vec3& c, double most) const noexcept;

  /// Calls `visit` with the place of each triangle nearer than `reach` [m], and of some others near
  /// those. Real-time safe, if `visit` is.
  template <typename Visit>
  void forEachAround(const Vec3& c, double reach, Visit visit) const noexcept {
    const double square = reach * reach;
    forEachLeaf(
        c, [square](double away) { return away <= square; }, visit);
  }

  /// Calls `visit` with the place of each triangle nearer than `reach` [m], and its distance.
  /// Real-time safe, if `visit` is.
  template <typename Visit>
  void forEachNear(const Vec3& c, double reach, Visit visit) const noexcept {
    forEachLeaf(
        c, [&](double square) { return square <= reach * reach; },
        [&](int triangle) {
          const double distance = computeDistance(c, triangle);
          if (distance <= reach) visit(triangle, distance);
        });
  }

 private:
  /// Of a binary tree of boxes; children of i are i + 1 and `second`.
  struct Node {
    Vec3 low, high;
    int second = -1;   ///< -1: a leaf
    int triangle = 0;  ///< first of a leaf, in order_
    int count = 0;     ///< of a leaf
  };

  void join(const std::vector<int>& vertices, double size);
  void makeDirections(const std::vector<int>& vertices, int vertex_count);
  int makeNode(int first, int count);
  [[nodiscard]] double computeDistance(const Vec3& c, int triangle) const noexcept;

  template <typename IsNear, typename Visit>
  void forEachLeaf(const Vec3& c, IsNear is_near, Visit visit) const noexcept {
    // Halves of halves: never deeper than this.
    int stack[64] = {0};
    int waiting = 1;
    while (waiting > 0) {
      const int at = stack[--waiting];
      const Node& node = nodes_[static_cast<std::size_t>(at)];
      const Vec3 apart = (node.low - c).cwiseMax(c - node.high).cwiseMax(0.0);
      if (!is_near(apart.squaredNorm())) continue;
      if (node.second < 0) {
        for (int i = 0; i < node.count; ++i)
          visit(order_[static_cast<std::size_t>(node.triangle + i)]);
      } else {
        stack[waiting++] = node.second;
        stack[waiting++] = at + 1;
      }
    }
  }

  std::vector<Triangle> triangles_;
  std::vector<Vec3> directions_;
  std::vector<Node> nodes_;
  std::vector<int> order_;
  bool is_closed_ = true;
  double bounding_radius_ = 0.0;
};

}  // namespace tandem
#pragma GCC visibility pop
