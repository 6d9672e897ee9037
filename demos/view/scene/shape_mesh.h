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
/// but open surfaces (meshes, height fields, planes, triangles) are closed. A plane is a square of
/// 2 m about the point that is nearest to the body's origin. Shapes without a surface (empty,
/// unknown) give an empty mesh. Allocates. Call it while nobody changes the shape.
[[nodiscard]] ShapeMesh makeShapeMesh(const btCollisionShape& shape);

/// Changes when the mesh of the shape would: it counts kind, scaling, margin, sizes and children, and
/// the address. Costs far less than the mesh.
[[nodiscard]] std::uint64_t computeShapeKey(const btCollisionShape& shape);

}  // namespace tandem::view
