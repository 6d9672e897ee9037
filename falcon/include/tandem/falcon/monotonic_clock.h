#pragma once

#pragma GCC visibility push(default)
namespace tandem {

/// The monotonic clock now [s], common to devices, loops and live peers. Real-time safe.
[[nodiscard]] double readMonotonicClock() noexcept;

/// Sleeps until the clock shows `moment` [s]; returns at once if it has passed. A signal does not
/// end the sleep early.
void sleepUntil(double moment) noexcept;

/// Sleeps for `seconds` [s], like sleepUntil().
void sleepFor(double seconds) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
