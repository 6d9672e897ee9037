#pragma once

#include "bench/reference/reference_run.h"

namespace tandem::demos::bench {

/// Solves a scene in which all contact is compliant and no body turns or meets another one.
///
/// Between events - a contact made, a contact broken, a new target - the motion is smooth and is
/// integrated by Runge-Kutta-Fehlberg 7(8) with error control at 1e-13. Make and break are located
/// by bisection down to rounding: each pair pushes exactly while its overlap and its force K d +
/// B d' are both positive. `max_step` [s] bounds a step; halving it tells the error that is left.
///
/// Throws std::invalid_argument if a contact would turn a body.
[[nodiscard]] ReferenceRun runSmoothReference(const BenchScene& scene, double max_step);

}  // namespace tandem::demos::bench
