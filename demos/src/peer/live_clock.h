#pragma once

#include <time.h>

namespace tandem::demos {

/// The monotonic clock since the program began, and sleep until a moment of it [s].
class LiveClock {
 public:
  LiveClock() noexcept { (void)clock_gettime(CLOCK_MONOTONIC, &origin_); }

  [[nodiscard]] double now() const noexcept {
    timespec now{};
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<double>(now.tv_sec - origin_.tv_sec) +
           1e-9 * static_cast<double>(now.tv_nsec - origin_.tv_nsec);
  }

  void sleepUntil(double moment) const noexcept {
    timespec until = origin_;
    const auto seconds = static_cast<time_t>(moment);
    until.tv_sec += seconds;
    until.tv_nsec += static_cast<long>((moment - static_cast<double>(seconds)) * 1e9);
    if (until.tv_nsec >= 1'000'000'000) {
      until.tv_nsec -= 1'000'000'000;
      ++until.tv_sec;
    }
    // A signal ends it early: whoever waits looks at why.
    (void)clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
  }

 private:
  timespec origin_{};
};

}  // namespace tandem::demos
