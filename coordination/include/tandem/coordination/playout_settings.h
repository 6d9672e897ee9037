#pragma once

#include <cstddef>

#pragma GCC visibility push(default)
namespace tandem {

/// Settings of the playout buffer, which applies unevenly arriving states at an even pace.
struct PlayoutSettings {
  bool is_on = true;       ///< off: states apply on arrival, as in the paper
  double most = 0.05;      ///< longest wait for slower packets [s]; longer smooths more jitter
  double quantile = 0.99;  ///< share of the last 256 packets that the wait should cover
  double slew =
      0.01;  ///< rate of change of the wait [s/s]; higher follows faster, lower is steadier
  double max_late =
      0.5;  ///< lateness behind the fastest packet above which a packet is dropped [s]
  std::size_t room = 64;  ///< most packets that wait at a time
};

/// Throws std::invalid_argument, naming the value and what is allowed.
void checkPlayoutSettings(const PlayoutSettings& settings);

}  // namespace tandem
#pragma GCC visibility pop
