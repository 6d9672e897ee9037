#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "tandem/coordination/shape.h"

#include "coordination/src/geometry/convex_polyhedron.h"
#include "coordination/src/geometry/triangle_mesh.h"

namespace tandem::test {

/// A solid by corners and faces, counter-clockwise seen from outside.
struct Solid {
  std::vector<Vec3> corners;
  std::vector<std::vector<int>> faces;
};

inline Solid makeBoxSolid(const Vec3& half) {
  Solid solid;
  for (int i = 0; i < 8; ++i)
    solid.corners.emplace_back((i & 1 ? 1 : -1) * half.x(), (i & 2 ? 1 : -1) * half.y(),
                               (i & 4 ? 1 : -1) * half.z());
  solid.faces = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                 {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  return solid;
}

/// An octahedron with a corner at each end of three axes.
inline Solid makeOctahedron(const Vec3& half) {
  Solid solid;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {1.0, -1.0})
      solid.corners.push_back(side * half[axis] * Vec3::Unit(axis));
  for (int i = 0; i < 8; ++i) {
    const int x = i & 1, y = 2 + (i >> 1 & 1), z = 4 + (i >> 2 & 1);
    const bool turned = ((i & 1) + (i >> 1 & 1) + (i >> 2 & 1)) % 2 == 1;
    solid.faces.push_back(turned ? std::vector<int>{x, z, y} : std::vector<int>{x, y, z});
  }
  return solid;
}

/// A prism of `count` sides along y.
inline Solid makePrism(double radius, double half_length, int count) {
  Solid solid;
  std::vector<int> top, bottom;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * 3.14159265358979323846 * i / count;
    for (const double side : {-1.0, 1.0})
      solid.corners.emplace_back(radius * std::cos(angle), side * half_length,
                                 radius * std::sin(angle));
    const int next = (i + 1) % count;
    solid.faces.push_back({2 * i, 2 * i + 1, 2 * next + 1, 2 * next});
    bottom.push_back(2 * i);
    top.insert(top.begin(), 2 * i + 1);
  }
  solid.faces.push_back(bottom);
  solid.faces.push_back(top);
  return solid;
}

inline ConvexHull makeHull(const Solid& solid, double rounding = 0.0) {
  return {std::make_shared<const ConvexPolyhedron>(solid.corners, solid.faces), rounding};
}

/// Three corners for each triangle; faces are cut into fans.
inline std::vector<Vec3> cutIntoTriangles(const Solid& solid) {
  std::vector<Vec3> corners;
  for (const std::vector<int>& face : solid.faces)
    for (std::size_t i = 2; i < face.size(); ++i)
      for (const int v : {face[0], face[i - 1], face[i]})
        corners.push_back(solid.corners[static_cast<std::size_t>(v)]);
  return corners;
}

inline Mesh makeMesh(const std::vector<Vec3>& corners, double skin = 0.0) {
  return {std::make_shared<const TriangleMesh>(corners), skin};
}

/// A floor at y = 0 with cells of length `cell`, `count` by `count` around the origin. Each cell is
/// cut along one of its diagonals.
inline std::vector<Vec3> makeFloor(int count, double cell) {
  std::vector<Vec3> corners;
  const auto at = [&](int i, int j) {
    return Vec3(cell * (i - 0.5 * count), 0.0, cell * (j - 0.5 * count));
  };
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) {
      const Vec3 a = at(i, j), b = at(i, j + 1), c = at(i + 1, j + 1), d = at(i + 1, j);
      if ((i + j) % 2 == 0)
        corners.insert(corners.end(), {a, b, c, a, c, d});
      else
        corners.insert(corners.end(), {a, b, d, b, c, d});
    }
  }
  return corners;
}

}  // namespace tandem::test
