#pragma once

#include <cstddef>

#pragma GCC visibility push(default)
namespace tandem {

/// How states that come unevenly are given at an even pace.
struct PlayoutSettings {
  bool is_on = true;       ///< off: states are applied as they come, as in the paper
  double most = 0.05;      ///< longest wait for slower packets [s]; longer smooths more jitter
  double quantile = 0.99;  ///< share of the last 256 packets that the wait should cover
  double slew = 0.01;      ///< change of the wait [s/s]; faster follows, slower is steadier
  double max_late = 0.5;   ///< later than the fastest by more [s]: too old to be applied
  std::size_t room = 64;   ///< packets that may wait at a time
};

/// Throws std::invalid_argument, naming the value and what is allowed.
void checkPlayoutSettings(const PlayoutSettings& settings);

}  // namespace tandem
#pragma GCC visibility pop
