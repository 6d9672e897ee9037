#include "tandem/coordination/passivity_observer.h"

#include <cmath>

#include "bad_value.h"

namespace tandem {
namespace {

/// Least share for a hand that puts energy in; with none an empty tank would stay empty.
constexpr double kLeastShare = 0.02;

}  // namespace

void checkPassivitySettings(const PassivitySettings& s) {
  const auto check = [](const char* name, double value, bool is_good, const char* allowed) {
    if (!is_good || !std::isfinite(value)) throwBadValue(name, value, allowed);
  };
  check("passivity.tank", s.tank, s.tank > 0.0, "a finite number > 0");
  check("passivity.band", s.band, s.band > 0.0 && s.band <= s.tank, "> 0, at most the tank");
  check("passivity.most", s.most, s.most >= 0.0, "a finite number >= 0");
}

double PassivityObserver::computeShare(double energy) const noexcept {
  const double left = std::max(0.0, available());
  const double share = std::min(1.0, left / settings_.band);
  if (energy <= 0.0) return std::max(share, kLeastShare);
  return energy * share > left ? left / energy : share;
}

}  // namespace tandem
