#pragma once

#pragma GCC visibility push(default)
namespace tandem {

/// The monotonic clock now [s]. Devices, loops and live peers all go by it. Real-time safe.
[[nodiscard]] double readMonotonicClock() noexcept;

/// Sleeps until the clock shows `moment` [s], at once if that has passed; a signal does not end it
/// early.
void sleepUntil(double moment) noexcept;

/// Sleeps for `seconds` [s], as sleepUntil().
void sleepFor(double seconds) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
