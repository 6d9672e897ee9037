#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <utility>

#include "tandem/coordination/types.h"

#include "scene/shape_mesh.h"

namespace tandem::view::test {

inline ShapeMesh::Vertex makeVertex(const Vec3& p, const Vec3& n) {
  ShapeMesh::Vertex vertex;
  for (int axis = 0; axis < 3; ++axis) {
    vertex.p[axis] = static_cast<float>(p[axis]);
    vertex.n[axis] = static_cast<float>(n[axis]);
  }
  return vertex;
}

/// Faces with normals of their own; half extents [m].
inline std::shared_ptr<const ShapeMesh> makeBox(const Vec3& half) {
  const auto mesh = std::make_shared<ShapeMesh>();
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const Vec3 n = side * Vec3::Unit(axis);
      const Vec3 u = Vec3::Unit((axis + 1) % 3), v = n.cross(u);
      const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
      for (const Vec3& corner :
           {Vec3(n - u - v), Vec3(n + u - v), Vec3(n + u + v), Vec3(n - u + v)})
        mesh->vertices.push_back(makeVertex(corner.cwiseProduct(half), n));
      for (const std::uint32_t k : {0U, 1U, 2U, 0U, 2U, 3U}) mesh->indices.push_back(first + k);
    }
  return mesh;
}

/// Smooth, of 24 segments.
inline std::shared_ptr<const ShapeMesh> makeBall(double radius) {
  constexpr std::uint32_t kSegments = 24, kRings = 12;
  const auto mesh = std::make_shared<ShapeMesh>();
  for (std::uint32_t ring = 0; ring <= kRings; ++ring)
    for (std::uint32_t segment = 0; segment < kSegments; ++segment) {
      const double down = std::numbers::pi * ring / kRings;
      const double round = 2.0 * std::numbers::pi * segment / kSegments;
      const Vec3 n(std::sin(down) * std::cos(round), std::sin(down) * std::sin(round),
                   std::cos(down));
      mesh->vertices.push_back(makeVertex(radius * n, n));
    }
  for (std::uint32_t ring = 0; ring < kRings; ++ring)
    for (std::uint32_t segment = 0; segment < kSegments; ++segment) {
      const std::uint32_t next = (segment + 1) % kSegments;
      const std::uint32_t a = ring * kSegments + segment, b = ring * kSegments + next;
      for (const std::uint32_t k : {a, a + kSegments, b, b, a + kSegments, b + kSegments})
        mesh->indices.push_back(k);
    }
  return mesh;
}

}  // namespace tandem::view::test
