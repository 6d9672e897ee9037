#pragma once

#include <cmath>

#include "geometry/plain_vec.h"

namespace tandem {

/// Cosine of half the turn from `from` to `to`. Above 0 the coefficients go the short way round,
/// below 0 the long way.
inline double computeTurnSide(const double* from, const double* to) noexcept {
  return to[3] * from[3] + to[0] * from[0] + to[1] * from[1] + to[2] * from[2];
}

/// Rotation vector of the turn from `from` to `to`, in W [rad]. `side` +1 goes the way of the
/// coefficients, -1 the other way round. Coefficients are x, y, z, w, of any nonzero length.
inline PlainVec computeTurn(const double* from, const double* to, double side) noexcept {
  // to * conj(from)
  double x = -to[3] * from[0] + to[0] * from[3] - to[1] * from[2] + to[2] * from[1];
  double y = -to[3] * from[1] + to[1] * from[3] - to[2] * from[0] + to[0] * from[2];
  double z = -to[3] * from[2] + to[2] * from[3] - to[0] * from[1] + to[1] * from[0];
  double w = computeTurnSide(from, to);
  if (side < 0.0) x = -x, y = -y, z = -z, w = -w;

  // The angle is 2 atan(sine / w). Small turns, the usual case, use the series. It is complete to
  // rounding, faster than atan2 and equal on every machine.
  const double square = x * x + y * y + z * z, ww = w * w;
  if (w > 0.0 && square < 0.01 * ww) {
    const double inverse = 1.0 / w, r = square * (inverse * inverse), rr = r * r;
    // 1 - r/3 + r^2/5 - ... in independent pairs.
    const double low = (1.0 - r * (1.0 / 3)) + rr * (1.0 / 5 - r * (1.0 / 7));
    const double high = (1.0 / 9 - r * (1.0 / 11)) + rr * (1.0 / 13 - r * (1.0 / 15));
    return (2.0 * inverse * (low + rr * rr * high)) * PlainVec(x, y, z);
  }
  const double sine = std::sqrt(square);
  return (2.0 * std::atan2(sine, w) / sine) * PlainVec(x, y, z);
}

/// Rotation vector the short way round.
inline PlainVec computeTurn(const double* from, const double* to) noexcept {
  return computeTurn(from, to, computeTurnSide(from, to) < 0.0 ? -1.0 : 1.0);
}

}  // namespace tandem
