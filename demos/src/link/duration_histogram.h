#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace tandem::demos {

/// Times from 100 ns to 100 s, counted in classes that are 0.05 % wide: percentiles of any number
/// of them in a room that is known from the start. What is outside counts as the nearest class.
/// add() is real-time safe.
class DurationHistogram {
 public:
  DurationHistogram() : counts_(kClasses) {}

  void add(double seconds) noexcept {
    const double place = std::log2(std::max(seconds, kShortest) / kShortest) * kPerOctave;
    ++counts_[std::min(static_cast<std::size_t>(place), kClasses - 1)];
    ++total_;
  }

  /// The time that a `share` of all does not exceed [s], to 0.03 %; not a number if there is none.
  [[nodiscard]] double percentile(double share) const noexcept {
    if (total_ == 0) return std::numeric_limits<double>::quiet_NaN();
    const double wanted = std::max(1.0, std::ceil(share * static_cast<double>(total_)));
    std::uint64_t passed = 0;
    std::size_t at = 0;
    for (; at + 1 < kClasses; ++at)
      if (static_cast<double>(passed += counts_[at]) >= wanted) break;
    return kShortest * std::exp2((static_cast<double>(at) + 0.5) / kPerOctave);
  }

 private:
  static constexpr double kShortest = 1e-7;  // [s]
  static constexpr double kPerOctave = 1400.0;
  static constexpr std::size_t kClasses = 30 * 1400;  // 2^30 is 1e9

  std::vector<std::uint64_t> counts_;
  std::uint64_t total_ = 0;
};

}  // namespace tandem::demos
