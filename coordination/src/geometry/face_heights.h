#pragma once

#include <algorithm>
#include <limits>

#include "geometry/convex_polyhedron.h"
#include "geometry/plain_vec.h"
#include "geometry/triangle_mesh.h"

namespace tandem {

/// Height of a centre over the plane of a face [m].
inline double heightOver(const ConvexPolyhedron::Face& face, const PlainVec& c) noexcept {
  return dot(PlainVec(face.normal), c) - face.offset;
}
inline double heightOver(const TriangleMesh::Triangle& triangle, const PlainVec& c) noexcept {
  return dot(PlainVec(triangle.normal), c) - triangle.offset;
}

/// Distance of the centre from the prism over a face [m]; negative inside the prism.
inline double computeWayBeside(const ConvexPolyhedron& solid, const ConvexPolyhedron::Face& face,
                               const PlainVec& c) noexcept {
  double farthest = -std::numeric_limits<double>::infinity();
  const ConvexPolyhedron::Side* side = solid.sides(face);
  for (int i = 0; i < face.count; ++i)
    farthest = std::max(farthest, dot(PlainVec(side[i].outward), c - PlainVec(side[i].start)));
  return farthest;
}

inline const TriangleMesh::Triangle& triangleAt(const TriangleMesh& mesh, int place) noexcept {
  return mesh.triangles()[static_cast<std::size_t>(place)];
}

}  // namespace tandem
