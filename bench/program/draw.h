#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "tandem/coordination/types.h"

namespace tandem::demos::bench {

/// Random draws from std::mt19937_64 alone: its numbers are equal everywhere, unlike
/// std::distributions'.
class Draw {
 public:
  Draw(std::uint64_t seed, std::uint64_t index) {
    std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                           static_cast<std::uint32_t>(index),
                           static_cast<std::uint32_t>(index >> 32)};
    engine_.seed(sequence);
  }
  double even(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  double log(double low, double high) { return std::exp(even(std::log(low), std::log(high))); }
  bool chance(double share) { return even(0.0, 1.0) < share; }
  int count(int low, int high) {
    return std::min(high, low + static_cast<int>(even(0.0, high - low + 1.0)));
  }
  Vec3 direction() {
    for (;;) {
      const Vec3 v(even(-1, 1), even(-1, 1), even(-1, 1));
      const double square = v.squaredNorm();
      if (square > 1e-3 && square < 1.0) return v / std::sqrt(square);
    }
  }
  Quat rotation() {
    for (;;) {
      const Eigen::Vector4d v(even(-1, 1), even(-1, 1), even(-1, 1), even(-1, 1));
      const double square = v.squaredNorm();
      if (square > 1e-3 && square < 1.0) return Quat(Eigen::Vector4d(v / std::sqrt(square)));
    }
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace tandem::demos::bench
