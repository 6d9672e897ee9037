#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace tandem::bench {

/// Timing of a host.
struct HostReport {
  std::uint64_t steps = 0;
  double step_median = 0.0, step_longest = 0.0;  ///< includes the host's waits in a step [s]
};

/// Runs a host in the calling thread from `begin` [s, monotonic clock]. It takes all steps of
/// `seconds`, each at its moment; a late one is made up for.
[[nodiscard]] HostReport runHost(double begin, double seconds, double rate,
                                 const std::function<void()>& step);

}  // namespace tandem::bench
