#pragma once

#include <cmath>
#include <cstddef>

namespace tandem {

// Plain loops of constant length: GCC turns them into vector instructions, and keeps Eigen's
// general products of matrices, which cost ten times as much at this size, out of the inner loops.

/// Six numbers of a body: a velocity or an impulse, linear then angular.
struct Six {
  double at[6] = {};

  void setZero() noexcept { *this = Six(); }
  void add(const Six& other) noexcept {
    for (int i = 0; i < 6; ++i) at[i] += other.at[i];
  }
  void addScaled(double scale, const Six& other) noexcept {
    for (int i = 0; i < 6; ++i) at[i] += scale * other.at[i];
  }
};

inline double dot(const Six& a, const Six& b) noexcept {
  double sum = 0.0;
  for (int i = 0; i < 6; ++i) sum += a.at[i] * b.at[i];
  return sum;
}

/// 6 x 6 matrix, by column.
struct SixBySix {
  Six column[6] = {};

  void setZero() noexcept { *this = SixBySix(); }
  void setIdentity() noexcept {
    setZero();
    for (int i = 0; i < 6; ++i) column[i].at[i] = 1.0;
  }

  /// *this += a b
  void addProduct(const SixBySix& a, const SixBySix& b) noexcept {
    for (int c = 0; c < 6; ++c)
      for (int k = 0; k < 6; ++k) column[c].addScaled(b.column[c].at[k], a.column[k]);
  }
  /// *this -= a b
  void subtractProduct(const SixBySix& a, const SixBySix& b) noexcept {
    for (int c = 0; c < 6; ++c)
      for (int k = 0; k < 6; ++k) column[c].addScaled(-b.column[c].at[k], a.column[k]);
  }
  /// x += (*this) y
  void addTo(Six& x, const Six& y) const noexcept {
    for (int c = 0; c < 6; ++c) x.addScaled(y.at[c], column[c]);
  }
  /// x -= (*this) y
  void subtractFrom(Six& x, const Six& y) const noexcept {
    for (int c = 0; c < 6; ++c) x.addScaled(-y.at[c], column[c]);
  }

  /// Becomes its inverse, by Gauss's and Jordan's elimination without pivoting. False if a pivot is
  /// 0, or the result not finite.
  [[nodiscard]] bool invert() noexcept {
    for (int k = 0; k < 6; ++k) {
      Six pivots = column[k];
      if (!(std::abs(pivots.at[k]) > 0.0)) return false;
      const double inverse = 1.0 / pivots.at[k];
      pivots.at[k] = 0.0;
      for (int c = 0; c < 6; ++c) {
        if (c == k) continue;
        const double factor = column[c].at[k] * inverse;
        column[c].addScaled(-factor, pivots);
        column[c].at[k] = factor;
      }
      for (int r = 0; r < 6; ++r) column[k].at[r] = -inverse * pivots.at[r];
      column[k].at[k] = inverse;
    }
    return std::isfinite(column[5].at[5]);
  }
};

}  // namespace tandem
