#include "tandem/coordination/passivity_observer.h"

#include <cmath>

#include "bad_value.h"

namespace tandem {
namespace {

/// Least share for a hand that puts energy in; with none an empty tank would stay empty.
constexpr double kLeastShare = 0.02;

/// Most of the remaining energy that one tick may take; the rest is for unexpected motion.
constexpr double kMostPerTick = 0.8;

/// Energy that is never given [J]: sums of small numbers must not round beyond the tank.
constexpr double kKept = 1e-6;

/// The share s at which s linear + s^2 quadratic = left, in the form without cancellation.
double computeLargestShare(const TickEnergy& whole, double left) noexcept {
  const double root = std::sqrt(whole.linear * whole.linear + 4.0 * whole.quadratic * left);
  if (whole.linear <= 0.0) return (root - whole.linear) / (2.0 * whole.quadratic);
  return 2.0 * left / (whole.linear + root);
}

}  // namespace

void checkPassivitySettings(const PassivitySettings& s) {
  const auto check = [](const char* name, double value, bool is_good, const char* allowed) {
    if (!is_good || !std::isfinite(value)) throwBadValue(name, value, allowed);
  };
  check("passivity.tank", s.tank, s.tank > 0.0, "a finite number > 0");
  check("passivity.band", s.band, s.band > 0.0 && s.band <= s.tank, "> 0, at most the tank");
  check("passivity.most", s.most, s.most >= 0.0, "a finite number >= 0");
  check("passivity.power", s.power, s.power >= 0.0, "a finite number >= 0");
  check("passivity.least_mass", s.least_mass, s.least_mass > 0.0, "a finite number > 0");
}

double PassivityObserver::computeShare(const TickEnergy& whole) const noexcept {
  const double left = std::max(0.0, available());
  double share = std::min(1.0, left / settings_.band);
  if (whole.linear <= 0.0) share = std::max(share, kLeastShare);
  const double most = std::max(0.0, kMostPerTick * left - kKept);
  if (share * (whole.linear + share * whole.quadratic) <= most) return share;
  return computeLargestShare(whole, most);
}

}  // namespace tandem
