#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "tandem/coordination/types.h"

namespace tandem::test {

/// Random numbers for property tests. It has its own distributions: the standard ones differ
/// between libraries.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1p-53;
  }
  /// Uniform on a logarithmic scale.
  double logUniform(double low, double high) { return low * std::pow(high / low, uniform(0, 1)); }
  /// Uniform in 0 to count - 1.
  int below(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }
  Vec3 inCube(double half) {
    const double x = uniform(-half, half), y = uniform(-half, half), z = uniform(-half, half);
    return {x, y, z};
  }
  Vec3 direction() {
    const double z = uniform(-1.0, 1.0), angle = uniform(0.0, 2.0 * kPi);
    const double across = std::sqrt(1.0 - z * z);
    return {across * std::cos(angle), across * std::sin(angle), z};
  }
  Quat rotation() {
    const Vec3 axis = direction();
    return Quat(Eigen::AngleAxisd(uniform(-kPi, kPi), axis));
  }

 private:
  static constexpr double kPi = 3.14159265358979323846;

  std::mt19937_64 engine_;
};

}  // namespace tandem::test
