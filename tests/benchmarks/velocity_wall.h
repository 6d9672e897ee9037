#pragma once

#include "velocity_candidates.h"

namespace tandem::bench {

/// A virtual wall that a hand presses on with 3 N, rendered at 1 kHz on a handle of 0.15 kg with
/// 0.5 N s/m of its own: f = K depth - B v while inside, held for a period.
struct Wall {
  double stiffness = 1000.0;  ///< K [N/m]
  double damping = 0.0;       ///< B [N s/m]
  int late_by = 0;            ///< periods after which a force reaches the motors
};

/// What is left of the motion in the end, from top to bottom [m]; the worst of a few places. It
/// gives up on a handle that has gone far off, with infinity. Without a candidate: with the true
/// position and velocity at the start of each period.
[[nodiscard]] double measureSwing(const Candidate* candidate, const Wall& wall);

/// The stiffest wall up to which all swing less than 0.1 mm [N/m], to a tenth; 0: none.
[[nodiscard]] double findStiffest(const Candidate* candidate, Wall wall);

}  // namespace tandem::bench
