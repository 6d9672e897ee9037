#pragma once

#include <algorithm>
#include <limits>

#pragma GCC visibility push(default)
namespace tandem {

/// Minimum of the latest values, over at least half the window and at most all of it. Only values
/// advance the time: the minimum before an outage is still known after it.
class WindowedMinimum {
 public:
  /// `window` [s].
  explicit WindowedMinimum(double window) noexcept : half_(0.5 * window) {}

  /// Real-time safe. `now` [s] must not run back.
  void add(double value, double now) noexcept {
    if (now - since_ >= half_) {
      before_ = now_;
      now_ = kNone;
      since_ = now;
    }
    now_ = std::min(now_, value);
  }

  /// Infinity before the first value.
  [[nodiscard]] double value() const noexcept { return std::min(before_, now_); }

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  double half_;
  double since_ = -kNone;
  double before_ = kNone, now_ = kNone;
};

}  // namespace tandem
#pragma GCC visibility pop
