#pragma once

#include <cmath>
#include <optional>

namespace tandem {

/// Maps the time of a site to the clock of its connection, and back: clock = site time + ahead.
///
/// Somebody who knows `ahead` sets it. Otherwise it is estimated from moments at which both times
/// were read.
class SiteClock {
 public:
  /// Keeps `ahead` [s] from here on, instead of an estimate.
  void set(double ahead) noexcept {
    ahead_ = ahead;
    is_estimated_ = false;
  }
  /// Forgets the estimate and makes no other: `ahead` is unknown until it is set.
  void waitUntilSet() noexcept {
    ahead_.reset();
    is_estimated_ = false;
  }

  /// Both times, read at about the same moment [s]. Each estimate takes 5 % of the change, since a
  /// host step or a tick lies between the two readings; above 100 ms it takes all of it.
  void note(double clock, double site_time) noexcept {
    if (!is_estimated_) return;
    const double ahead = clock - site_time;
    if (!ahead_ || std::abs(ahead - *ahead_) > kJump) ahead_ = ahead;
    *ahead_ += kShare * (ahead - *ahead_);
  }

  [[nodiscard]] bool isKnown() const noexcept { return ahead_.has_value(); }
  [[nodiscard]] bool isSet() const noexcept { return isKnown() && !is_estimated_; }
  /// 0 ahead while it is not known.
  [[nodiscard]] double toClock(double site_time) const noexcept {
    return site_time + ahead_.value_or(0.0);
  }
  [[nodiscard]] double toSite(double clock) const noexcept { return clock - ahead_.value_or(0.0); }

 private:
  static constexpr double kShare = 0.05;  ///< of a change, in each estimate
  static constexpr double kJump = 0.1;    ///< a clock was set, or time was lost [s]

  std::optional<double> ahead_;  // [s]
  bool is_estimated_ = true;
};

}  // namespace tandem
