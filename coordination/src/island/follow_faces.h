#pragma once

#include "island/touch.h"

/// \file
/// Brings the face that a sphere has touched to where the sphere is now, and remembers it for the
/// next tick.
namespace tandem {

/// Returns the gap [m]; remembers the face if that is below `reach` [m]. Not for a whole mesh.
double followFace(IslandModel& model, const States& states, Touch& touch, double reach) noexcept;

/// The same for a whole mesh. Calls `visit(piece)` for each piece with a gap below `reach`.
template <typename Visit>
void followPieces(IslandModel& model, const States& states, Touch& whole, double reach,
                  Visit visit) noexcept {
  int touched = -1;
  double least = reach;
  forEachPiece(model, whole, states, reach, [&](const Touch& piece, double gap) {
    if (!(gap < reach)) return;
    visit(piece);
    if (!(gap < least) || !isOverFace(model, piece, states)) return;
    touched = piece.piece;
    least = gap;
  });
  whole.touched = touched;
  if (touched >= 0) model.faces.keep(keyOf(model, whole), touched, least);
}

}  // namespace tandem
