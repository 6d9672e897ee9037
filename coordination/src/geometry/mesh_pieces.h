#pragma once

#include "geometry/held_face.h"
#include "geometry/triangle_mesh.h"

namespace tandem {

/// The feature of a triangle that pushes: its face, or an edge `feature - kMeshEdge` or corner
/// `feature - kMeshCorner` that it owns.
enum MeshFeature { kMeshFace = 0, kMeshEdge = 1, kMeshCorner = 4, kMeshFeatures = 7 };

/// Gap of a sphere to a piece [m]: the distance to the place where it would be pushed.
inline double computeGap(const Separation& piece, double radius) noexcept {
  const double gap = piece.distance - radius;
  return piece.aside > 0.0 ? std::max(gap, piece.aside) : gap;
}

/// Calls `visit(piece, separation)` for each piece nearer than `reach` [m] that pushes a centre at
/// `c_B`. Includes pieces that would push after a move of at most `move` [m]. `touched`: the piece
/// that the sphere has touched, or -1.
template <typename Visit>
void forEachPiece(const PlainVec& c_B, const Mesh& mesh, int touched, double reach, double move,
                  Visit visit) {
  const Vec3 c = c_B.toVec3();
  double search = reach + mesh.skin;
  if (touched >= 0 && isBehind(c_B, *mesh.surface, touched)) {
    // Its own plane may be the nearest that pushes.
    const Separation own = leaveByFace(c_B, mesh, touched, kMeshFace);
    search = std::max(search, 2.0 * (move + mesh.skin - own.distance));
  } else if (!(mesh.surface->findNearest(c, search) < search)) {
    // Far outside, or deep inside. At a concave edge, the farther walls push as well.
    const Separation whole = separate(c_B, mesh);
    if (!(whole.distance < 0.0)) return;
    search = 2.0 * (move - whole.distance);
  }
  mesh.surface->forEachAround(c, search, [&](int piece) {
    const Separation found = separate(c_B, mesh, piece, touched);
    if (found.distance < reach && found.aside <= move) visit(piece, found);
  });
}

}  // namespace tandem
