#pragma once

#include <cmath>

#include "geometry/plain_vec.h"

namespace tandem {

/// Cosine of half the turn from `from` to `to`; above 0 the short way round is the one that the
/// coefficients themselves go, below 0 the other.
inline double computeTurnSide(const double* from, const double* to) noexcept {
  return to[3] * from[3] + to[0] * from[0] + to[1] * from[1] + to[2] * from[2];
}

/// Rotation vector of the turn from `from` to `to`, in W [rad], the way round that `side` says: +1
/// as the coefficients go, -1 the other. Coefficients in the order x, y, z, w, of any length but
/// zero.
inline PlainVec computeTurn(const double* from, const double* to, double side) noexcept {
  // to * conj(from)
  double x = -to[3] * from[0] + to[0] * from[3] - to[1] * from[2] + to[2] * from[1];
  double y = -to[3] * from[1] + to[1] * from[3] - to[2] * from[0] + to[0] * from[2];
  double z = -to[3] * from[2] + to[2] * from[3] - to[0] * from[1] + to[1] * from[0];
  double w = computeTurnSide(from, to);
  if (side < 0.0) x = -x, y = -y, z = -z, w = -w;

  // The angle is 2 atan(sine / w). Copies that follow each other are near: for them the series,
  // complete to rounding, which is faster than atan2 and the same on every machine.
  const double square = x * x + y * y + z * z, ww = w * w;
  if (w > 0.0 && square < 0.01 * ww) {
    const double inverse = 1.0 / w, r = square * (inverse * inverse), rr = r * r;
    // 1 - r/3 + r^2/5 - ... in pairs, which do not wait for each other.
    const double low = (1.0 - r * (1.0 / 3)) + rr * (1.0 / 5 - r * (1.0 / 7));
    const double high = (1.0 / 9 - r * (1.0 / 11)) + rr * (1.0 / 13 - r * (1.0 / 15));
    return (2.0 * inverse * (low + rr * rr * high)) * PlainVec(x, y, z);
  }
  const double sine = std::sqrt(square);
  return (2.0 * std::atan2(sine, w) / sine) * PlainVec(x, y, z);
}

/// The short way round.
inline PlainVec computeTurn(const double* from, const double* to) noexcept {
  return computeTurn(from, to, computeTurnSide(from, to) < 0.0 ? -1.0 : 1.0);
}

}  // namespace tandem
