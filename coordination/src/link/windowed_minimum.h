#pragma once

#include <algorithm>
#include <limits>

#pragma GCC visibility push(default)
namespace tandem {

/// The least of the values of the last while: of at least half the window, at most the whole.
/// Values make time pass, silence does not: what was least before an outage is remembered after it.
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
