#pragma once

#pragma GCC visibility push(default)
namespace tandem {

/// The monotonic clock now [s]: what loops and links of a live site go by. Real-time safe.
[[nodiscard]] double readMonotonicClock() noexcept;

/// Sleeps until a moment of it [s], at once if that has passed; a signal does not end it early.
void sleepUntil(double moment) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
