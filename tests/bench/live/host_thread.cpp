#include "host_thread.h"

#include <algorithm>
#include <cmath>

#include "tandem/falcon/monotonic_clock.h"

namespace tandem::bench {

HostReport runHost(double begin, double seconds, double rate, const std::function<void()>& step) {
  const auto count = static_cast<std::uint64_t>(std::llround(seconds * rate));
  std::vector<double> times;
  times.reserve(count);
  for (std::uint64_t i = 1; i <= count; ++i) {
    sleepUntil(begin + static_cast<double>(i) / rate);
    const double start = readMonotonicClock();
    step();
    times.push_back(readMonotonicClock() - start);
  }
  std::sort(times.begin(), times.end());
  if (times.empty()) return {};
  return {count, times[times.size() / 2], times.back()};
}

}  // namespace tandem::bench
