#pragma once

#include <limits>

namespace tandem {

/// Moments closer than this are one moment [s]: far below a tick, far above the rounding of a day
/// of seconds.
inline constexpr double kSameTime = 1e-10;

/// The host's clock is a sum in btScalar. Its moments may be off the ticks' by this much [s].
inline constexpr double kClockTolerance = 1e-9;

inline constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace tandem
