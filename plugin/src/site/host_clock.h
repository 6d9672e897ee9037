#pragma once

#include <algorithm>
#include <cstdint>

#include "site/moments.h"

namespace tandem {

/// The host's simulated time, in the site's time.
///
/// The host's clock is the sum of its steps. A late host may catch up step by step. Time that it
/// dropped never comes back, so its clock is advanced. Plain value; real-time safe.
class HostClock {
 public:
  /// `step` is the expected length of the host's steps [s], 0 if unknown. `stall` [s] is how late
  /// the host may be in addition.
  HostClock(double step, double stall) noexcept : step_(step), stall_(stall) {}

  [[nodiscard]] double time() const noexcept { return time_; }
  /// Length of the latest step [s]; 0 if unknown.
  [[nodiscard]] double step() const noexcept { return step_; }
  /// Length of the latest step, or 1/60 s while it is unknown.
  [[nodiscard]] double expectedStep() const noexcept { return step_ > 0.0 ? step_ : 1.0 / 60.0; }
  /// Delay of the host's forces [s].
  [[nodiscard]] double lateness() const noexcept { return lateness_; }
  /// True if the clock was advanced in the present step because the host had stood still.
  [[nodiscard]] bool hasJumped() const noexcept { return has_jumped_; }
  /// Number of times the clock was advanced.
  [[nodiscard]] std::uint64_t timesSet() const noexcept { return times_set_; }

  /// The first tick is at `now`. Earlier host steps lie outside the site's time, except one that
  /// may be under way. Returns the shift of the clock [s].
  double begin(double now) noexcept {
    const double shift = now - std::max(0.0, time_ - step_);
    time_ += shift;
    return shift;
  }
  void setStep(double step) noexcept { step_ = step; }
  void endStep(double dt) noexcept { time_ += dt; }

  /// A step of `dt` begins while the island is at `island_time` [s]. Advances the clock of a host
  /// that has dropped time.
  void follow(double island_time, double dt) noexcept;
  /// Like follow(), for a live host, whose clock offset never corrects itself. A host ahead of the
  /// island is set back to it. One that is more than `kept` seconds late has stood still: its clock
  /// is advanced at once. One that stays late for a second is advanced by the least lateness in it,
  /// if that exceeds a tick's `period` [s].
  void followLive(double island_time, double dt, double kept, double period) noexcept;
  /// Updates the delay of the host's forces. For ticks that run outside the host's steps.
  void watchLateness(double island_time, double dt, double period) noexcept;

 private:
  double time_ = 0.0, step_;
  double stall_;  ///< how late the host may be in addition [s]
  double lateness_ = 0.0;
  double least_late_ = kNever, watched_ = 0.0;  ///< of the present watch, and its length [s]
  bool has_jumped_ = false;
  std::uint64_t times_set_ = 0;
};

}  // namespace tandem
