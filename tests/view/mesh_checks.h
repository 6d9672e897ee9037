#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btConvexShape.h>

#include "tandem/coordination/types.h"

#include "scene/shape_mesh.h"

/// \file
/// What any surface must keep, whatever shape it is of.
namespace tandem::test {

using view::ShapeMesh;
using Triangle = std::array<Vec3, 3>;

inline Vec3 toVec3(const float (&v)[3]) { return {v[0], v[1], v[2]}; }
inline Vec3 toVec3(const btVector3& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

inline std::vector<Triangle> trianglesOf(const ShapeMesh& mesh) {
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    triangles.push_back({toVec3(mesh.vertices.at(mesh.indices[i]).p),
                         toVec3(mesh.vertices.at(mesh.indices[i + 1]).p),
                         toVec3(mesh.vertices.at(mesh.indices[i + 2]).p)});
  }
  return triangles;
}

/// Along the outward normal, twice as long as the triangle is large.
inline Vec3 areaVector(const Triangle& t) { return (t[1] - t[0]).cross(t[2] - t[0]); }

/// By the divergence theorem; negative if the surface is inside out [m^3].
inline double volumeOf(const ShapeMesh& mesh) {
  double volume = 0.0;
  for (const Triangle& t : trianglesOf(mesh)) volume += t[0].dot(t[1].cross(t[2])) / 6.0;
  return volume;
}

/// Expects that each edge has one triangle on either side, after welding equal positions.
inline void expectClosed(const ShapeMesh& mesh) {
  using Position = std::array<float, 3>;
  std::map<std::pair<Position, Position>, int> uses;
  const auto at = [&](std::size_t i) { return std::to_array(mesh.vertices.at(mesh.indices[i]).p); };
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
    ++uses[{at(i), at(next)}];
  }
  ASSERT_FALSE(uses.empty());
  std::size_t faults = 0;
  for (const auto& [edge, count] : uses) {
    const auto back = uses.find({edge.second, edge.first});
    if (count != 1 || back == uses.end() || back->second != 1) ++faults;
  }
  EXPECT_EQ(faults, 0U) << "of " << uses.size() << " edges";
}

/// Expects normals of length 1 on the side from which the triangle is counter-clockwise.
inline void expectNormalsOutward(const ShapeMesh& mesh) {
  const std::vector<Triangle> triangles = trianglesOf(mesh);
  double largest = 0.0;
  for (const Triangle& t : triangles) largest = std::max(largest, areaVector(t).norm());
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const Vec3 normal = toVec3(mesh.vertices.at(mesh.indices[i]).n);
    EXPECT_NEAR(normal.norm(), 1.0, 1e-5);
    const Vec3 area = areaVector(triangles[i / 3]);
    // The direction of a sliver is lost in the rounding of its corners.
    if (area.norm() > 1e-4 * largest) {
      EXPECT_GT(normal.dot(area.normalized()), 0.5) << i;
    }
  }
}

inline void expectSolid(const ShapeMesh& mesh) {
  expectClosed(mesh);
  expectNormalsOutward(mesh);
}

/// Expects that all triangles are there from both sides, and gives back the area of one [m^2].
inline double areaOfBothSides(const ShapeMesh& mesh) {
  expectNormalsOutward(mesh);
  Vec3 sum = Vec3::Zero();
  double area = 0.0;
  for (const Triangle& t : trianglesOf(mesh)) {
    sum += areaVector(t);
    area += areaVector(t).norm() / 2;
  }
  EXPECT_LT(sum.norm(), 1e-6 * area);
  EXPECT_NEAR(volumeOf(mesh), 0.0, 1e-6 * area);
  return area / 2;
}

/// Expects the volume of the true shape [m^3] but for the part that the facets cut off.
inline void expectVolume(const ShapeMesh& mesh, double volume, double cut_off) {
  EXPECT_LE(volumeOf(mesh), volume * (1.0 + 1e-5));
  EXPECT_GE(volumeOf(mesh), volume * (1.0 - cut_off));
}

/// Expects that the mesh is in the shape's bounds and comes within `gap` of each [m].
inline void expectFillsBounds(const ShapeMesh& mesh, const btCollisionShape& shape, double gap) {
  btVector3 low, high;
  shape.getAabb(btTransform::getIdentity(), low, high);
  const double rounding = 1e-6 * (toVec3(low).norm() + toVec3(high).norm());
  ASSERT_FALSE(mesh.vertices.empty());
  Vec3 mesh_low = toVec3(mesh.vertices[0].p), mesh_high = mesh_low;
  for (const ShapeMesh::Vertex& vertex : mesh.vertices) {
    mesh_low = mesh_low.cwiseMin(toVec3(vertex.p));
    mesh_high = mesh_high.cwiseMax(toVec3(vertex.p));
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_GE(mesh_low[axis], toVec3(low)[axis] - rounding) << axis;
    EXPECT_LE(mesh_low[axis], toVec3(low)[axis] + rounding + gap) << axis;
    EXPECT_LE(mesh_high[axis], toVec3(high)[axis] + rounding) << axis;
    EXPECT_GE(mesh_high[axis], toVec3(high)[axis] - rounding - gap) << axis;
  }
}

/// Furthest reach of the mesh in a direction [m].
inline double reachOf(const ShapeMesh& mesh, const Vec3& direction) {
  double reach = -1e30;
  for (const ShapeMesh::Vertex& vertex : mesh.vertices) {
    reach = std::max(reach, toVec3(vertex.p).dot(direction));
  }
  return reach;
}

}  // namespace tandem::test
