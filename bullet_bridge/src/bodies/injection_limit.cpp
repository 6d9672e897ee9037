#include <cmath>
#include <limits>

#include "bodies/haptic_body.h"

namespace tandem {

double computeInjectionStepLimit(double stiffness, double damping, double mass) noexcept {
  // The header's formula with c = z w = B / (2 m), expanded by sqrt(c^2 + w^2) + c. It works for K
  // = 0 and has no cancellation.
  const double c = damping / (2.0 * mass);
  const double rate = c + std::sqrt(c * c + stiffness / mass);
  return rate > 0.0 ? 2.0 / rate : std::numeric_limits<double>::infinity();
}

}  // namespace tandem
