#pragma once

#include <algorithm>
#include <cstdint>

#include "site/moments.h"

namespace tandem {

/// The host's simulated time, in the time of its site.
///
/// A host sums up its own steps. It may be late and make up for it, step by step; one that has
/// dropped time never will, and its clock is set on. Plain value; real-time safe.
class HostClock {
 public:
  /// `step` is the expected length of the host's steps [s]; 0: not known.
  HostClock(double step, double stall) noexcept : step_(step), stall_(stall) {}

  [[nodiscard]] double time() const noexcept { return time_; }
  /// Length of the latest step [s]; 0: not known.
  [[nodiscard]] double step() const noexcept { return step_; }
  /// The same, or a usual step until there is one [s].
  [[nodiscard]] double expectedStep() const noexcept { return step_ > 0.0 ? step_ : 1.0 / 60.0; }
  /// By which the host's forces come late [s].
  [[nodiscard]] double lateness() const noexcept { return lateness_; }
  /// True if the clock was set on in the present step because the host had stood still.
  [[nodiscard]] bool hasJumped() const noexcept { return has_jumped_; }
  /// How often the clock was set on.
  [[nodiscard]] std::uint64_t timesSet() const noexcept { return times_set_; }

  /// The first tick is at `now`. Steps before it are not of the site's time, but for the one that
  /// may be under way. Returns the shift [s].
  double begin(double now) noexcept {
    const double shift = now - std::max(0.0, time_ - step_);
    time_ += shift;
    return shift;
  }
  void setStep(double step) noexcept { step_ = step; }
  void endStep(double dt) noexcept { time_ += dt; }

  /// A step of `dt` begins while the island is at `island_time`: who has dropped time is set on.
  void follow(double island_time, double dt) noexcept;
  /// The same of a host with a clock of its own, which is early or late until somebody sets it. One
  /// that asks for the future gets the present: its clock is set back. One that asks for more than
  /// `kept` seconds ago has stood still: its clock is set on at once. One that is late all through
  /// a second is set on by the least lateness in it; `period` of the ticks [s].
  void followLive(double island_time, double dt, double kept, double period) noexcept;
  /// Follows the lateness of the host's forces, for ticks that the host's steps do not make.
  void watchLateness(double island_time, double dt, double period) noexcept;

 private:
  double time_ = 0.0, step_;
  double stall_;  ///< by which the host may be late besides [s]
  double lateness_ = 0.0;
  double least_late_ = kNever, watched_ = 0.0;  ///< in the present watch, and its length [s]
  bool has_jumped_ = false;
  std::uint64_t times_set_ = 0;
};

}  // namespace tandem
