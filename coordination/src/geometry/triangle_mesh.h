#pragma once

#include <array>
#include <vector>

#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

/// A surface of triangles in its body's frame, touched by spheres. Immutable; built at set-up. A
/// Mesh refers to it.
///
/// Triangles are one-sided. Corners run counter-clockwise seen from the free side; behind is solid.
/// An outside centre is pushed by each feature in whose region it is:
///
///   face           over the face, up to its edges
///   convex edge    beyond both faces, between the edge's ends; the same for open edges
///   convex corner  beyond the ends of all its edges
///
/// Coplanar faces thus push once, and both sides of a groove push. At a blunt concave edge (less
/// than 60 degrees off flat) each face pushes on its side of the plane between them. A bowl thus
/// pushes once. An inside centre leaves through the nearest face, and through all walls of a sharp
/// concave edge. A surface with open edges pushes only down to kDeepest behind it, unless the
/// sphere has touched it (held_face.h).
class TriangleMesh {
 public:
  /// How faces meet at an edge of a triangle.
  enum class Meeting : char {
    kFlat,     ///< coplanar or blunt concave: the plane between the faces parts them
    kConvex,   ///< the edge pushes
    kConcave,  ///< each pushes as a plane beyond the edge while the centre is behind the other
    kOpen,     ///< there is no other face
  };

  /// Edge k of a triangle, from corner k to the next.
  struct Edge {
    Vec3 start = Vec3::Zero(), end = Vec3::Zero();  ///< equal for both triangles, as is `along`
    Vec3 along = Vec3::Zero();                      ///< unit vector
    Vec3 inward = Vec3::Zero();  ///< unit normal of the parting plane, towards the triangle
    Meeting meeting = Meeting::kOpen;
    bool is_owner = false;  ///< the edge pushes as a feature of this triangle
    int mate = -1;          ///< the same edge in the other triangle, 3 triangle + k; -1: none
  };
  struct Corner {
    Vec3 p = Vec3::Zero();
    bool is_owner = false;     ///< the corner pushes as a feature of this triangle
    int first = 0, count = 0;  ///< range of its directions
  };
  struct Triangle {
    Vec3 normal = Vec3::UnitX();
    double offset = 0.0;
    std::array<Edge, 3> edges;
    std::array<Corner, 3> corners;
    Vec3 middle = Vec3::Zero();
  };

  static constexpr double kDeepest = 0.1;  ///< an open surface pushes down to this depth [m]

  /// `corners`: three per triangle. Corners nearer to each other than 1e-6 of the size are merged.
  /// Triangles without area are dropped. Throws std::invalid_argument for non-finite values or if
  /// no triangle remains.
  explicit TriangleMesh(const std::vector<Vec3>& corners);

  [[nodiscard]] const std::vector<Triangle>& triangles() const noexcept { return triangles_; }
  /// Unit vectors along all edges of a corner, away from it.
  [[nodiscard]] const Vec3* directions(const Corner& corner) const noexcept {
    return directions_.data() + corner.first;
  }
  [[nodiscard]] bool isClosed() const noexcept { return is_closed_; }
  /// Radius of the sphere around the body's origin that holds the mesh [m].
  [[nodiscard]] double boundingRadius() const noexcept { return bounding_radius_; }

  /// Distance to the nearest triangle [m], or `most` if that is less. Real-time safe.
  [[nodiscard]] double findNearest(const Vec3& c, double most) const noexcept;

  /// Calls `visit` with the index of each triangle nearer than `reach` [m], and of some others
  /// nearby. Real-time safe, if `visit` is.
  template <typename Visit>
  void forEachAround(const Vec3& c, double reach, Visit visit) const noexcept {
    const double square = reach * reach;
    forEachLeaf(
        c, [square](double away) { return away <= square; }, visit);
  }

  /// Calls `visit` with the index and distance of each triangle nearer than `reach` [m]. Real-time
  /// safe, if `visit` is.
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
  /// Node of a binary tree of boxes; the children of node i are i + 1 and `second`.
  struct Node {
    Vec3 low, high;
    int second = -1;   ///< -1: a leaf
    int triangle = 0;  ///< first triangle of a leaf, in order_
    int count = 0;     ///< number of triangles of a leaf
  };

  void join(const std::vector<int>& vertices, double size);
  void makeDirections(const std::vector<int>& vertices, int vertex_count);
  int makeNode(int first, int count);
  [[nodiscard]] double computeDistance(const Vec3& c, int triangle) const noexcept;

  template <typename IsNear, typename Visit>
  void forEachLeaf(const Vec3& c, IsNear is_near, Visit visit) const noexcept {
    // The tree halves the triangles, so it is never deeper than this.
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
