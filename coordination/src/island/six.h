#pragma once

#include <cmath>
#include <cstddef>
#include <cstring>

namespace tandem {

/// Six numbers of a body: a velocity or an impulse, linear then angular.
///
/// They are taken in pairs, as processors have them. Left to itself GCC makes loops through memory
/// of it, and Eigen general products of matrices: both cost several times as much.
struct Six {
  alignas(16) double at[6] = {};

  void setZero() noexcept { *this = Six(); }
  void add(const Six& other) noexcept {
    set(pair(0) + other.pair(0), pair(2) + other.pair(2), pair(4) + other.pair(4));
  }
  void addScaled(double scale, const Six& other) noexcept {
    const Pair both = {scale, scale};
    set(pair(0) + both * other.pair(0), pair(2) + both * other.pair(2),
        pair(4) + both * other.pair(4));
  }
  [[nodiscard]] Six scaled(double scale) const noexcept {
    const Pair both = {scale, scale};
    Six six;
    six.set(both * pair(0), both * pair(2), both * pair(4));
    return six;
  }

 private:
  using Pair = double __attribute__((vector_size(16)));
  friend double dot(const Six& a, const Six& b) noexcept;

  [[nodiscard]] Pair pair(int i) const noexcept {
    Pair pair;
    std::memcpy(&pair, at + i, sizeof pair);
    return pair;
  }
  void set(const Pair& first, const Pair& second, const Pair& third) noexcept {
    std::memcpy(at, &first, sizeof first);
    std::memcpy(at + 2, &second, sizeof second);
    std::memcpy(at + 4, &third, sizeof third);
  }
};

inline double dot(const Six& a, const Six& b) noexcept {
  const Six::Pair sums = a.pair(0) * b.pair(0) + a.pair(2) * b.pair(2) + a.pair(4) * b.pair(4);
  return sums[0] + sums[1];
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
    for (int c = 0; c < 6; ++c) {
      Six sum = column[c];
      for (int k = 0; k < 6; ++k) sum.addScaled(b.column[c].at[k], a.column[k]);
      column[c] = sum;
    }
  }
  /// *this -= a b
  void subtractProduct(const SixBySix& a, const SixBySix& b) noexcept {
    for (int c = 0; c < 6; ++c) {
      Six sum = column[c];
      for (int k = 0; k < 6; ++k) sum.addScaled(-b.column[c].at[k], a.column[k]);
      column[c] = sum;
    }
  }
  /// x += (*this) y
  void addTo(Six& x, const Six& y) const noexcept {
    Six sum = x;
    for (int c = 0; c < 6; ++c) sum.addScaled(y.at[c], column[c]);
    x = sum;
  }
  /// x -= (*this) y
  void subtractFrom(Six& x, const Six& y) const noexcept {
    Six sum = x;
    for (int c = 0; c < 6; ++c) sum.addScaled(-y.at[c], column[c]);
    x = sum;
  }

  /// Becomes its inverse, by Gauss's and Jordan's elimination without pivoting. False if a pivot is
  /// 0, or the result not finite.
  [[nodiscard]] bool invert() noexcept {
    for (int k = 0; k < 6; ++k) {
      const Six pivots = column[k];
      if (!(std::abs(pivots.at[k]) > 0.0)) return false;
      const double inverse = 1.0 / pivots.at[k];
      double factors[6];
      for (int c = 0; c < 6; ++c) {
        factors[c] = column[c].at[k] * inverse;
        if (c != k) column[c].addScaled(-factors[c], pivots);
      }
      column[k] = pivots.scaled(-inverse);
      factors[k] = inverse;
      for (int c = 0; c < 6; ++c) column[c].at[k] = factors[c];
    }
    return std::isfinite(column[5].at[5]);
  }
};

}  // namespace tandem
