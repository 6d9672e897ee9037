#include "scene/hull_mesh.h"

#include <cmath>
#include <numbers>

#include <LinearMath/btConvexHullComputer.h>

#include "scene/mesh_parts.h"

namespace tandem::view {
namespace {

constexpr int kSpreadDirections = 374;  // 400 with those of the cube

/// Adds directions that are spread evenly over the sphere, along a spiral.
void addSpreadDirections(std::vector<btVector3>& directions) {
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (int i = 0; i < kSpreadDirections; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kSpreadDirections;
    const double across = std::sqrt(1.0 - z * z);
    directions.emplace_back(static_cast<btScalar>(across * std::cos(golden_angle * i)),
                            static_cast<btScalar>(across * std::sin(golden_angle * i)),
                            static_cast<btScalar>(z));
  }
}

std::vector<btVector3> makeSampleDirections() {
  std::vector<btVector3> directions;
  for (const btVector3& direction : makeCubeDirections()) {
    directions.push_back(direction / direction.length());
  }
  addSpreadDirections(directions);
  return directions;
}

/// Corners of one face of a hull, counter-clockwise from outside. They are taken from the points
/// given, because the computed ones are rounded to a ten-thousandth of the hull.
std::vector<btVector3> faceCorners(const btConvexHullComputer& hull, int face,
                                   const std::vector<btVector3>& points) {
  std::vector<btVector3> corners;
  const btConvexHullComputer::Edge* const first = &hull.edges[hull.faces[face]];
  const btConvexHullComputer::Edge* edge = first;
  do {
    const int original = hull.original_vertex_index[edge->getSourceVertex()];
    corners.push_back(points[static_cast<std::size_t>(original)]);
    edge = edge->getNextEdgeOfFace();
  } while (edge != first);
  return corners;
}

}  // namespace

ShapeMesh makeHullMesh(const std::vector<btVector3>& points) {
  ShapeMesh mesh;
  if (points.empty()) return mesh;
  btConvexHullComputer hull;
  hull.compute(points.front().m_floats, sizeof(btVector3), static_cast<int>(points.size()), 0, 0);
  for (int face = 0; face < hull.faces.size(); ++face) {
    addFacet(mesh, faceCorners(hull, face, points));
  }
  return mesh;
}

std::vector<btVector3> findSupports(const btConvexShape& shape) {
  static const std::vector<btVector3> kDirections = makeSampleDirections();
  std::vector<btVector3> supports;
  supports.reserve(kDirections.size());
  for (const btVector3& direction : kDirections) {
    supports.push_back(shape.localGetSupportingVertex(direction));
  }
  return supports;
}

std::array<btVector3, 26> makeCubeDirections() {
  std::array<btVector3, 26> directions;
  std::size_t count = 0;
  for (int cell = 0; cell < 27; ++cell) {
    const int x = cell % 3 - 1, y = cell / 3 % 3 - 1, z = cell / 9 - 1;
    if (x == 0 && y == 0 && z == 0) continue;
    directions[count++].setValue(static_cast<btScalar>(x), static_cast<btScalar>(y),
                                 static_cast<btScalar>(z));
  }
  return directions;
}

}  // namespace tandem::view
