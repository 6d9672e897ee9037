#pragma once

#include "session/pace.h"
#include "session/site_pair.h"

namespace tandem::view {

/// Lets two sites without haptic threads follow a clock at a pace. The clock is passed in [s].
class PacedTime {
 public:
  /// Time passes from `clock` on. A pause at the start first takes 20 ms of the sites' time, in
  /// which forces come back that faded with the haptic threads. `pair` must outlive this.
  PacedTime(SitePair& pair, double clock, const Pace& pace);

  /// Makes the ticks that are due at `clock`. A machine that is too slow for them drops time beyond
  /// 20 ms. A pause begins with the end of a host step. While paused, `steps` host steps are made.
  void advance(double clock, const Pace& pace, int steps = 0);

 private:
  void begin(double clock, const Pace& pace);

  SitePair& pair_;
  Pace pace_;
  double clock_ = 0.0, time_ = 0.0;  ///< since when the pace holds, by the clock and the sites [s]
};

}  // namespace tandem::view
