#pragma once

#include <algorithm>
#include <cmath>
#include <complex>

/// \file
/// Textbook criteria for the stiffness of a contact or a coordination, to compare with the exact
/// border. Each gives the largest stiffness [N/m] that it allows; below 0 it allows none.
namespace tandem::demos {

/// A mass with a damper, tied by a spring-damper to `others` times its own delayed state: two equal
/// users who move together or against each other. The device's hold is not in it.
struct DelayedChain {
  double mass = 0.0;     ///< M [kg]
  double damper = 0.0;   ///< b [N s/m]
  double damping = 0.0;  ///< B, of the spring-damper [N s/m]
  double others = 1.0;   ///< n, weight of the spring-damper
};

/// Age of what a site knows of another, on average: the delay and half a packet [s].
[[nodiscard]] inline double computeAge(double delay, double packet_rate) noexcept {
  return delay + 0.5 / packet_rate;
}

/// A wall that is felt through a sampled device, with any passive hand: b > K T / 2 + B.
/// Source: Colgate and Schenkel, passivity of a class of sampled-data systems.
[[nodiscard]] inline double limitByColgateSchenkel(double device_damping, double contact_damping,
                                                   double period) noexcept {
  return 2.0 * (device_damping - contact_damping) / period;
}

/// The same wall without a hand, stable but not passive: K T / 2 < B + b.
[[nodiscard]] inline double limitByWall(double device_damping, double contact_damping,
                                        double period) noexcept {
  return 2.0 * (device_damping + contact_damping) / period;
}

/// Springs with dampers to the ground on both sides: b >= K tau, for every passive hand. It gives
/// no credit to the coupling's damping. Source: Lee and Spong; Nuno et al., P+d control.
[[nodiscard]] inline double limitByGroundedDamper(double damper, double age) noexcept {
  return damper / age;
}

/// Largest stiffness of a chain that is stable at every delay: (b^2 + 2 n b B) / (2 n M).
[[nodiscard]] inline double limitAtEveryDelay(const DelayedChain& c) noexcept {
  return c.damper * (c.damper + 2.0 * c.others * c.damping) / (2.0 * c.others * c.mass);
}

/// Shortest delay at which a chain of that stiffness is at the border [s], infinite if none is.
/// There is a frequency w at which the loop's gain is 1: M^2 w^2 = 2 n K M - b^2 - 2 n b B. Its
/// phase gives the delay.
[[nodiscard]] inline double computeCriticalDelay(const DelayedChain& c, double stiffness) noexcept {
  const double excess = stiffness - limitAtEveryDelay(c);
  if (!(excess > 0.0)) return HUGE_VAL;
  constexpr double kTurn = 6.283185307179586;
  const double n = c.others, w = std::sqrt(2.0 * n * excess / c.mass);
  const std::complex<double> own(n * stiffness - c.mass * w * w, w * (c.damper + n * c.damping));
  const std::complex<double> heard(n * stiffness, n * w * c.damping);
  // e^(-j w T) is own / heard for users who move together, and minus that against each other.
  const double together = std::fmod(kTurn - std::arg(own / heard), kTurn);
  const double against = std::fmod(together + 0.5 * kTurn, kTurn);
  return std::min(together, against) / w;
}

/// Largest stiffness of a chain that is stable at delays up to `age`, to 1e-9 of it.
[[nodiscard]] inline double limitByChain(const DelayedChain& c, double age) noexcept {
  double stays = limitAtEveryDelay(c), changes = std::max(1.0, 2.0 * stays);
  while (computeCriticalDelay(c, changes) > age) changes *= 2.0;
  while (changes - stays > 1e-9 * changes) {
    const double middle = 0.5 * (stays + changes);
    (computeCriticalDelay(c, middle) > age ? stays : changes) = middle;
  }
  return stays;
}

}  // namespace tandem::demos
