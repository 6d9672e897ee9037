#pragma once

#include <algorithm>
#include <cmath>

namespace tandem::falcon_detail {

/// Time that passes for a simulated thing, by the times that it is told. Time before the first
/// call, backwards and beyond the longest step does not pass.
class PassedTime {
 public:
  explicit PassedTime(double longest_step) noexcept : longest_step_(longest_step) {}

  /// Returns how much passes until `now` [s]; 0 unless it is finite.
  double pass(double now) noexcept {
    if (!std::isfinite(now)) return 0.0;
    const double step = was_told_ ? std::clamp(now - told_, 0.0, longest_step_) : 0.0;
    sum_ += step;
    told_ = now;
    was_told_ = true;
    return step;
  }
  [[nodiscard]] double sum() const noexcept { return sum_; }  ///< [s]

 private:
  double longest_step_;  ///< [s]
  double told_ = 0.0;    ///< time of the last call [s]
  double sum_ = 0.0;
  bool was_told_ = false;
};

}  // namespace tandem::falcon_detail
