#pragma once

#include "bench/reference/reference_run.h"

namespace tandem::demos::bench {

/// Solves a scene in which all contact is compliant, and bodies neither turn nor touch each other.
///
/// Events are contacts that begin or end, and new targets. Between events the motion is smooth and
/// is integrated by Runge-Kutta-Fehlberg 7(8) with error control at 1e-13. Begin and end of contact
/// are located by bisection down to rounding: a pair pushes exactly while its overlap and its force
/// K d + B d' are both positive. `max_step` [s] bounds a step; halving it shows the remaining
/// error.
///
/// Throws std::invalid_argument if a contact would turn a body.
[[nodiscard]] ReferenceRun runSmoothReference(const BenchScene& scene, double max_step);

}  // namespace tandem::demos::bench
