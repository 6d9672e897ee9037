#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/speed/speed_way.h"

namespace tandem::demos::bench {

/// One scene in one way: medians over short blocks of steps. All ways of a scene take turns.
/// Comparisons of two are medians over turns, so that other load affects both.
struct SpeedResult {
  SpeedWay way = SpeedWay::kBare60;
  double us_per_second = 0.0;   ///< run time per simulated second, ticks included [us]
  double us_per_step = 0.0;     ///< Bullet's step with its callbacks [us]
  double us_per_tick = 0.0;     ///< a haptic tick outside the step [us]; 0 if none
  double step_over_bare = 0.0;  ///< us_per_step minus that of Bullet alone at 60 Hz [us]
  double times_cheaper = 0.0;   ///< ratio to the whole world at 1 kHz, per second; 0 without that
};

struct SpeedCase {
  std::string name;
  SpeedScene scene;
  std::vector<SpeedResult> results;

  /// Null if the way was not measured.
  [[nodiscard]] const SpeedResult* find(SpeedWay way) const;
};

/// Cost of Island::advance for one haptic period.
struct IslandTick {
  std::string name;
  double us = 0.0;
  double limit_us = 0.0;
};

/// A number that this machine should reach.
struct SpeedCheck {
  std::string name;
  double value = 0.0;
  double limit = 0.0;
  std::string unit;
  bool at_least = false;  ///< the value should be at least the limit; else at most

  [[nodiscard]] bool isMet() const { return at_least ? value >= limit : value <= limit; }
};

struct SpeedReport {
  std::vector<SpeedCase> cases;
  std::vector<IslandTick> island_ticks;
  std::vector<SpeedCheck> checks;
};

/// Called with the current activity and the finished share of the work.
using SpeedProgress = std::function<void(std::string_view what, double share)>;

/// Measures on this machine. `quick`: fewer scenes, blocks and steps.
[[nodiscard]] SpeedReport measureSpeed(bool quick, const SpeedProgress& progress);

}  // namespace tandem::demos::bench
