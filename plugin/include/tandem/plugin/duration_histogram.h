#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#pragma GCC visibility push(default)
namespace tandem {

/// Histogram of durations from 100 ns to 100 s, in classes 0.05 % wide. It gives percentiles of any
/// number of durations in fixed memory. Values outside count in the nearest class. One thread adds,
/// real-time safe; any thread may read meanwhile.
class DurationHistogram {
 public:
  DurationHistogram() : counts_(kClasses) {}

  void add(double seconds) noexcept {
    const double place = std::log2(std::max(seconds, kShortest) / kShortest) * kPerOctave;
    increment(counts_[std::min(static_cast<std::size_t>(place), kClasses - 1)]);
    increment(total_);
  }

  [[nodiscard]] std::uint64_t count() const noexcept {
    return total_.load(std::memory_order_relaxed);
  }

  /// Duration that a `share` of all values does not exceed [s], to 0.03 %. NaN if there are none.
  [[nodiscard]] double percentile(double share) const noexcept {
    const std::uint64_t total = count();
    if (total == 0) return std::numeric_limits<double>::quiet_NaN();
    const double wanted = std::max(1.0, std::ceil(share * static_cast<double>(total)));
    std::uint64_t passed = 0;
    std::size_t at = 0;
    for (; at + 1 < kClasses; ++at) {
      passed += counts_[at].load(std::memory_order_relaxed);
      if (static_cast<double>(passed) >= wanted) break;
    }
    return kShortest * std::exp2((static_cast<double>(at) + 0.5) / kPerOctave);
  }

 private:
  using Count = std::atomic<std::uint64_t>;

  /// One writer needs no atomic read-modify-write.
  static void increment(Count& count) noexcept {
    count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }

  static constexpr double kShortest = 1e-7;  // [s]
  static constexpr double kPerOctave = 1400.0;
  static constexpr std::size_t kClasses = 30 * 1400;  // 2^30 is 1e9

  std::vector<Count> counts_;
  Count total_{0};
};

}  // namespace tandem
#pragma GCC visibility pop
