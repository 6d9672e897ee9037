#include "island/oscillator_map.h"

namespace tandem {
namespace {

/// Terms of the series; the last is below 1e-18 of the first for the step length in use.
constexpr int kTerms = 16;

/// Most halvings; enough for any sensible gain.
constexpr int kMaxHalvings = 200;

}  // namespace

OscillatorMap computeOscillatorMap(double stiffness, double damping, double h) noexcept {
  // S is the displacement from rest after a unit impulse: S'' + c S' + k S = 0 with S(0) = 0 and
  // S'(0) = 1. Its series covers a step that is short against the fastest motion; doubling extends
  // it.
  int halvings = 0;
  while ((damping * h > 0.5 || stiffness * h * h > 0.25) && halvings < kMaxHalvings)
    h *= 0.5, ++halvings;

  const double ch = damping * h, khh = stiffness * h * h;
  OscillatorMap map;
  map.velocity_to_velocity = 0.0;
  double before = 0.0, term = h;  // terms of S, n - 1 and n
  for (int n = 1; n <= kTerms; ++n) {
    map.velocity_to_way += term;
    map.acceleration_to_way += term / (n + 1);
    map.velocity_to_velocity += n * term;
    const double next = -(ch * term + khh * before / n) / (n + 1);
    before = term;
    term = next;
  }
  map.acceleration_to_way *= h;
  map.velocity_to_velocity = h > 0.0 ? map.velocity_to_velocity / h : 1.0;

  for (; halvings > 0; --halvings) {
    const double S = map.velocity_to_way, J = map.acceleration_to_way;
    const double R = map.velocity_to_velocity;
    const double stays = 1.0 - stiffness * J;  // share of x left after the step
    map.velocity_to_way = S * (stays + R);
    map.acceleration_to_way = J * (1.0 + stays) + S * S;
    map.velocity_to_velocity = R * R - stiffness * S * S;
  }
  return map;
}

}  // namespace tandem
