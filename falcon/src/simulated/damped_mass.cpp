#include "simulated/damped_mass.h"

#include <cmath>

namespace tandem::falcon_detail {
namespace {

/// (1 - e^-a) / a. Only a = 0 needs the limit: expm1 is accurate for every smaller a.
double computePhi1(double a) noexcept { return a > 0.0 ? -std::expm1(-a) / a : 1.0; }

/// (1 - phi1) / a. Below 1/2 the difference would cancel, so it sums the series 1/2! - a/3! +
/// a^2/4! - ... Its 14 terms leave a remainder below 1e-17 there.
double computePhi2(double a) noexcept {
  if (a >= 0.5) return (1.0 - computePhi1(a)) / a;
  double sum = 1.0;
  for (int n = 15; n >= 3; --n) sum = 1.0 - sum * a / n;
  return 0.5 * sum;
}

}  // namespace

DampedMassStep::DampedMassStep(double mass, double damping, double h) noexcept {
  const double a = damping / mass * h;
  kept_velocity_ = std::exp(-a);
  position_per_velocity_ = h * computePhi1(a);
  velocity_per_force_ = position_per_velocity_ / mass;
  position_per_force_ = h * h * computePhi2(a) / mass;
}

}  // namespace tandem::falcon_detail
