#pragma once

namespace tandem {

/// Exact motion of one degree of freedom under a constant force, over one time step:
///
///   x'' + c x' + k x = const.    ->    x(h) = x + S v + J g,   v(h) = R v + S g
///
/// g is the present acceleration at zero velocity (all forces except those of dampers). One formula
/// without division by k or c covers parabola, decay and oscillation. It only adds to x, so it is
/// equally exact a kilometre from the origin.
struct OscillatorMap {
  double velocity_to_way = 0.0;       ///< S [s]
  double acceleration_to_way = 0.0;   ///< J, the integral of S [s^2]
  double velocity_to_velocity = 1.0;  ///< R, the derivative of S
  double acceleration_to_velocity() const { return velocity_to_way; }
};

/// `stiffness` k [1/s^2] and `damping` c [1/s] are per mass, >= 0; `h` [s] >= 0. Uses only
/// additions and multiplications: equal bits on every machine. Real-time safe, about 0.1 us.
[[nodiscard]] OscillatorMap computeOscillatorMap(double stiffness, double damping,
                                                 double h) noexcept;

}  // namespace tandem
