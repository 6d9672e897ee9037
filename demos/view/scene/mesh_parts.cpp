#include "scene/mesh_parts.h"

#include <array>
#include <cmath>

namespace tandem::view {
namespace {

void store(const btVector3& from, float (&to)[3]) {
  for (int axis = 0; axis < 3; ++axis) to[axis] = static_cast<float>(from[axis]);
}

btVector3 load(const float (&from)[3]) { return {from[0], from[1], from[2]}; }

/// Twice the polygon's area, along its normal. All corners count, so that a corner on the straight
/// line between two others does no harm.
btVector3 computeAreaVector(std::span<const btVector3> corners) {
  btVector3 area(0, 0, 0);
  for (std::size_t i = 2; i < corners.size(); ++i) {
    area += (corners[i - 1] - corners[0]).cross(corners[i] - corners[0]);
  }
  return area;
}

/// The side of a box that faces along `axis`, or against it if `sign` is negative.
std::array<btVector3, 4> boxSide(const btVector3& half, int axis, btScalar sign) {
  btVector3 middle(0, 0, 0), across(0, 0, 0), up(0, 0, 0);
  const int second = (axis + 1) % 3, third = (axis + 2) % 3;
  middle[axis] = sign * half[axis];
  across[second] = half[second];
  up[third] = sign * half[third];
  return {middle - across - up, middle + across - up, middle + across + up, middle - across + up};
}

}  // namespace

std::uint32_t addVertex(ShapeMesh& mesh, const btVector3& p, const btVector3& n) {
  ShapeMesh::Vertex vertex;
  store(p, vertex.p);
  store(n, vertex.n);
  mesh.vertices.push_back(vertex);
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

void addFacet(ShapeMesh& mesh, std::span<const btVector3> corners) {
  const btVector3 area = computeAreaVector(corners);
  const btScalar length = area.length();
  if (!std::isfinite(length) || length <= 0) return;

  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const btVector3& corner : corners) addVertex(mesh, corner, area / length);
  for (std::uint32_t i = 2; i < corners.size(); ++i) {
    mesh.indices.insert(mesh.indices.end(), {first, first + i - 1, first + i});
  }
}

void appendPart(ShapeMesh& mesh, const ShapeMesh& part, const btTransform& X_BP) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const ShapeMesh::Vertex& vertex : part.vertices) {
    addVertex(mesh, X_BP * load(vertex.p), X_BP.getBasis() * load(vertex.n));
  }
  for (const std::uint32_t index : part.indices) mesh.indices.push_back(first + index);
}

void scaleMesh(ShapeMesh& mesh, btScalar factor) {
  for (ShapeMesh::Vertex& vertex : mesh.vertices) store(load(vertex.p) * factor, vertex.p);
}

ShapeMesh makeBoxMesh(const btVector3& half_extents) {
  ShapeMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    addFacet(mesh, boxSide(half_extents, axis, 1));
    addFacet(mesh, boxSide(half_extents, axis, -1));
  }
  return mesh;
}

}  // namespace tandem::view
