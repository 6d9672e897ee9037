#pragma once

#include <optional>
#include <vector>

#include "engine.h"
#include "words.h"

namespace tandem::pybullet {

/// One piece of a body's shape as Tandem has it: `settings` with shape and size, and where it
/// stands in the body's frame.
struct Piece {
  TandemBodySettings settings;
  double position[3]{};
  double orientation[4]{0.0, 0.0, 0.0, 1.0};
  std::vector<double> points;  // of a hull; settings.points is set to them at use

  bool isCentred() const;
};

/// The piece that the words `shape=` and `size=` of a command describe; none without `shape=`.
/// `points`: x, y, z of each of a hull's. Throws Refusal.
std::optional<Piece> readPieceFromWords(Words& words, const std::vector<double>& points);

/// Pieces of what PyBullet says of a body's shape. Throws Refusal for what it does not say, or says
/// of shapes that Tandem does not have; the text names the remedy.
std::vector<Piece> readPieces(const Engine& engine, int body, const BodyFacts& facts);

/// Where a piece of a body in `pose` stands.
TandemState computePieceState(const TandemState& pose, const Piece& piece);

}  // namespace tandem::pybullet
