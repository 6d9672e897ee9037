#pragma once

namespace tandem {

/// Exact motion of one degree of freedom under a constant force, over one step of time:
///
///   x'' + c x' + k x = const.    ->    x(h) = x + S v + J g,   v(h) = R v + S g
///
/// where g is the acceleration that the body would have now if it stood still (all forces but
/// those of dampers). No division by k or c: parabola, decay and oscillation are one formula, and
/// it only ever adds to x, so that it is as exact a kilometre off the origin.
struct OscillatorMap {
  double velocity_to_way = 0.0;       ///< S [s]
  double acceleration_to_way = 0.0;   ///< J, the integral of S [s^2]
  double velocity_to_velocity = 1.0;  ///< R, the derivative of S
  double acceleration_to_velocity() const { return velocity_to_way; }
};

/// `stiffness` k [1/s^2] and `damping` c [1/s] are per mass, >= 0; `h` [s] >= 0. Adds and
/// multiplies only: equal bits on every machine. Real-time safe, about 0.1 us.
[[nodiscard]] OscillatorMap computeOscillatorMap(double stiffness, double damping,
                                                 double h) noexcept;

}  // namespace tandem
