#pragma once

#include "tandem/coordination/types.h"

namespace tandem::falcon_detail {

/// Exact solution of m x'' + b x' = f over a step of length h with constant f:
///
///   v(h) = e^-a v + f/m h phi1        a = b h / m
///   x(h) = x + h phi1 v + f/m h^2 phi2
///   phi1 = (1 - e^-a) / a,  phi2 = (1 - phi1) / a
///
/// As a -> 0, phi1 -> 1 and phi2 -> 1/2: the free mass. As a -> infinity, phi1 -> 1/a: the mass
/// moves at its terminal velocity f/b. Accurate to rounding for every finite a >= 0.
class DampedMassStep {
 public:
  DampedMassStep(double mass, double damping, double h) noexcept;

  [[nodiscard]] PointState advance(const PointState& from, const Vec3& f) const noexcept {
    return {from.p_W + position_per_velocity_ * from.v_W + position_per_force_ * f,
            kept_velocity_ * from.v_W + velocity_per_force_ * f};
  }

 private:
  double kept_velocity_;          ///< e^-a
  double position_per_velocity_;  ///< h phi1 [s]
  double velocity_per_force_;     ///< h phi1 / m [m/s/N]
  double position_per_force_;     ///< h^2 phi2 / m [m/N]
};

}  // namespace tandem::falcon_detail
