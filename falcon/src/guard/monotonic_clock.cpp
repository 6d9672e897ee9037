#include "tandem/falcon/monotonic_clock.h"

#include <cerrno>

#include <time.h>

namespace tandem {

double readMonotonicClock() noexcept {
  timespec now{};
  (void)clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void sleepUntil(double moment) noexcept {
  timespec until{};
  until.tv_sec = static_cast<time_t>(moment);
  until.tv_nsec = static_cast<long>((moment - static_cast<double>(until.tv_sec)) * 1e9);
  constexpr long kNanoseconds = 1'000'000'000;
  if (until.tv_nsec >= kNanoseconds) {
    until.tv_nsec -= kNanoseconds;
    ++until.tv_sec;
  }
  // A handled signal interrupts clock_nanosleep(), so it is repeated.
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

void sleepFor(double seconds) noexcept { sleepUntil(readMonotonicClock() + seconds); }

}  // namespace tandem
