#pragma once

#include <limits>

namespace tandem {

/// Two moments closer than this count as the same [s]. It is far below a tick and far above the
/// rounding of a day in seconds.
inline constexpr double kSameTime = 1e-10;

/// The host's clock is a sum in btScalar, so its moments may differ from the ticks' by this much
/// [s].
inline constexpr double kClockTolerance = 1e-9;

inline constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace tandem
