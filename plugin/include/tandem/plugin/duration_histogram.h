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

/// Times from 100 ns to 100 s, counted in classes that are 0.05 % wide: percentiles of any number
/// of them in a room that is known from the start. What is outside counts as the nearest class.
/// One thread adds, real-time safe; any may read meanwhile.
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

  /// The time that a `share` of all does not exceed [s], to 0.03 %; not a number if there is none.
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

  /// There is one writer: no need for the bus to be locked.
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
