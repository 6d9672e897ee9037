#pragma once

#include <optional>
#include <vector>

#include "engine.h"
#include "words.h"

namespace tandem::pybullet {

/// One piece of a body's shape: `settings` with shape and size, and its pose in the body's frame.
struct Piece {
  TandemBodySettings settings;
  double position[3]{};
  double orientation[4]{0.0, 0.0, 0.0, 1.0};
  std::vector<double> points;  // of a hull; settings.points refers to them in use

  bool isCentred() const;
};

/// Reads the words `shape=` and `size=` of a command; empty without `shape=`. `points` has x, y, z
/// of each hull point. Throws Refusal.
std::optional<Piece> readPieceFromWords(Words& words, const std::vector<double>& points);

/// Reads a body's shape from PyBullet. Throws Refusal with the remedy if PyBullet does not tell it,
/// or Tandem does not support it.
std::vector<Piece> readPieces(const Engine& engine, int body, const BodyFacts& facts);

/// World pose of a piece of a body in `pose`.
TandemState computePieceState(const TandemState& pose, const Piece& piece);

}  // namespace tandem::pybullet
