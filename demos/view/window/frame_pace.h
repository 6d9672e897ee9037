#pragma once

#include <algorithm>

#include "tandem/falcon/monotonic_clock.h"

namespace tandem::view {

/// At most 60 pictures a second. A late one does not hurry those after it.
class FramePace {
 public:
  /// Waits until the next picture is due; returns that moment on the monotonic clock [s].
  double wait() {
    sleepUntil(next_);
    const double now = readMonotonicClock();
    next_ = std::max(next_ + kPeriod, now);
    return now;
  }

 private:
  static constexpr double kPeriod = 1.0 / 60.0;  // [s]
  double next_ = 0.0;
};

}  // namespace tandem::view
