#pragma once

namespace tandem::view {

/// How the time of a session passes.
struct Pace {
  double speed = 1.0;      ///< sites' time by the clock's, above 0 and at most 1
  bool is_paused = false;  ///< the sites' time stands still

  /// True if sites may tick against the clock.
  [[nodiscard]] bool isRealTime() const noexcept { return speed == 1.0 && !is_paused; }
  [[nodiscard]] bool operator==(const Pace&) const = default;
};

}  // namespace tandem::view
