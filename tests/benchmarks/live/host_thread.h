#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace tandem::bench {

/// How a host fared.
struct HostReport {
  std::uint64_t steps = 0;
  double step_median = 0.0, step_longest = 0.0;  ///< with what the host waits for in them [s]
};

/// A host in the calling thread: from `begin` [s, monotonic clock] on it takes all steps of
/// `seconds`, each at its moment; one that is late makes up for it.
[[nodiscard]] HostReport runHost(double begin, double seconds, double rate,
                                 const std::function<void()>& step);

}  // namespace tandem::bench
