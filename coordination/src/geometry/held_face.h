#pragma once

#include "geometry/separation.h"

// clang-format off
/// \file
/// A face that a sphere touched from outside holds its centre, as a god object does: faces that are
/// turned away from it do not push, however deep the centre is, and also behind the shape. The
/// centre is free once it has gone around the shape.
///
///         touched            held                free
///           o
///       +---------+       +---------+         +---------+
///       |         |       |         |         |         |  o
///       +---------+       +---------+         +---------+
///                             o  (pushed up)
// clang-format on
namespace tandem {

/// The face through which a centre behind the touched face leaves; -1 if the centre is in front of
/// that or free. Not for a mesh.
[[nodiscard]] int followFace(const PlainVec& c, const Shape& shape, int touched) noexcept;

/// Lead of this face over the nearest other that is not turned away from the touched one [m].
/// Negative: the centre leaves through another face, or is free.
[[nodiscard]] double computeHeldLead(const PlainVec& c, const Shape& shape, int face,
                                     int touched) noexcept;

/// Separation by the face that holds the centre, else by the whole shape. Not for a mesh.
inline Separation separate(const PlainVec& c, const Shape& shape, int touched) noexcept {
  const Separation nearest = separate(c, shape);
  if (touched < 0 || nearest.under == touched) return nearest;
  const int face = followFace(c, shape, touched);
  return face < 0 ? nearest : leaveAnyByFace(c, shape, -1, face);
}

/// True if a centre is behind a triangle of a mesh.
[[nodiscard]] bool isBehind(const PlainVec& c, const TriangleMesh& mesh, int triangle) noexcept;

/// True if a triangle does not push, as the centre is behind the touched one (-1: none) and this
/// one is turned away. The other wall of a groove is not.
[[nodiscard]] bool isHidden(const PlainVec& c, const TriangleMesh& mesh, int touched,
                            int triangle) noexcept;

}  // namespace tandem
