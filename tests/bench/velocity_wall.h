#pragma once

#include "velocity_candidates.h"

namespace tandem::bench {

/// A virtual wall rendered at 1 kHz that a hand presses with 3 N. The handle has 0.15 kg and 0.5 N
/// s/m of its own. Inside, f = K depth - B v, held for a period.
struct Wall {
  double stiffness = 1000.0;  ///< K [N/m]
  double damping = 0.0;       ///< B [N s/m]
  int late_by = 0;            ///< periods until a force reaches the motors
};

/// Peak-to-peak motion left in the end [m], worst of a few places. Infinity if the handle goes far
/// off. Without a candidate the true position and velocity at the start of each period are used.
[[nodiscard]] double measureSwing(const Candidate* candidate, const Wall& wall);

/// Largest stiffness below which every wall swings less than 0.1 mm [N/m], to a tenth; 0: none.
[[nodiscard]] double findStiffest(const Candidate* candidate, Wall wall);

}  // namespace tandem::bench
