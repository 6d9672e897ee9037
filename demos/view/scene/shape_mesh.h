#pragma once

#include <cstdint>
#include <vector>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>

namespace tandem::view {

/// Triangles of a shape's surface in the body's frame, as a graphics card takes them.
struct ShapeMesh {
  struct Vertex {
    float p[3] = {};  ///< [m]
    float n[3] = {};  ///< outward unit normal
  };
  std::vector<Vertex> vertices;
  /// Three for each triangle, counter-clockwise as seen from outside.
  std::vector<std::uint32_t> indices;
};

/// Makes the surface of any shape of Bullet, with its scaling and margin as Bullet collides it. All
/// but open surfaces (meshes, height fields, planes, triangles) are closed; those have both sides.
/// A plane is a square of 2 m about the point that is nearest to the body's origin. Shapes without
/// a surface (empty, unknown, points and lines) give an empty mesh.
///
/// Hulls of points, triangles and simplices are drawn without their margin, as their makers gave
/// them. Boxes have sharp edges, as Bullet's box against box has. Round shapes have 16 strips.
///
/// Allocates. Call it while nobody changes the shape.
[[nodiscard]] ShapeMesh makeShapeMesh(const btCollisionShape& shape);

/// Changes when the mesh of the shape would: it counts kind, scaling, margin, sizes and children,
/// and the address. Costs far less than the mesh. It does not see vertices of a mesh, nor heights
/// of a field, that are changed in place within the same bounds.
[[nodiscard]] std::uint64_t computeShapeKey(const btCollisionShape& shape);

}  // namespace tandem::view
