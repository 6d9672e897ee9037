#include <cmath>
#include <limits>

#include "bodies/haptic_body.h"

namespace tandem {

double computeInjectionStepLimit(double stiffness, double damping, double mass) noexcept {
  // The formula of the header with c = z w = B / (2 m), and numerator and denominator multiplied by
  // sqrt(c^2 + w^2) + c: good for K = 0 and without cancellation.
  const double c = damping / (2.0 * mass);
  const double rate = c + std::sqrt(c * c + stiffness / mass);
  return rate > 0.0 ? 2.0 / rate : std::numeric_limits<double>::infinity();
}

}  // namespace tandem
