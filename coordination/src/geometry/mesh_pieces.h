#pragma once

#include "geometry/separation.h"
#include "geometry/triangle_mesh.h"

namespace tandem {

/// What of a triangle may push: its face, or the edge or corner `feature - kMeshEdge` or
/// `feature - kMeshCorner`, if it owns that.
enum MeshFeature { kMeshFace = 0, kMeshEdge = 1, kMeshCorner = 4, kMeshFeatures = 7 };

/// Gap of a sphere to a piece [m]: the way to where it would be pushed.
inline double computeGap(const Separation& piece, double radius) noexcept {
  const double gap = piece.distance - radius;
  return piece.aside > 0.0 ? std::max(gap, piece.aside) : gap;
}

/// Calls `visit(piece, separation)` with each piece of a mesh that pushes a centre at c (in the
/// mesh's frame) nearer than `reach` [m] to it, or would after a move of no more than `move` [m].
template <typename Visit>
void forEachPiece(const PlainVec& c_B, const Mesh& mesh, double reach, double move, Visit visit) {
  const Vec3 c = c_B.toVec3();
  double search = reach + mesh.skin;
  if (!(mesh.surface->findNearest(c, search) < search)) {
    // Far outside, or deep inside. Of walls that meet at a concave edge one may be farther.
    const Separation whole = separate(c_B, mesh);
    if (!(whole.distance < 0.0)) return;
    search = 2.0 * (move - whole.distance);
  }
  mesh.surface->forEachAround(c, search, [&](int piece) {
    const Separation found = separate(c_B, mesh, piece);
    if (found.distance < reach && found.aside <= move) visit(piece, found);
  });
}

}  // namespace tandem
