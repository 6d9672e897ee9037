#pragma once

#include <cmath>

#include "geometry/separation.h"

namespace tandem::detail {

/// A centre in the coordinates of a round shape, and the direction out of its side.
struct Round {
  double along, across;
  PlainVec outwards;
};

inline Round lookAlong(const PlainVec& c, Axis axis) noexcept {
  const PlainVec v = layAlongY(c, axis);
  const double across = std::sqrt(v.x * v.x + v.z * v.z);
  if (across < kOnCore) return {v.y, across, layBack({1.0, 0.0, 0.0}, axis)};
  return {v.y, across, layBack({v.x / across, 0.0, v.z / across}, axis)};
}

inline PlainVec pointAlong(Axis axis, double side) noexcept {
  return layBack({0.0, side, 0.0}, axis);
}

}  // namespace tandem::detail
