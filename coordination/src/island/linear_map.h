#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace tandem {

/// Exact motion of n coupled degrees of freedom under forces that are linear in time:
///
///   M x'' + C x' + S x = u + w t
///
/// The state after a step h is one matrix times (x, v, u, w), taken from the exponential of the
/// augmented system. Matrices are built once for a period T and its binary parts T/2^k, so that any
/// time in the period is a few products away and events can be located by binary descent.
class LinearMap {
 public:
  /// Parts down to T/2^31: 2.3e-13 s of a millisecond.
  static constexpr int kLevels = 32;

  LinearMap() = default;

  /// `mass` is the diagonal of M, positive. Allocates.
  LinearMap(double period, const Eigen::VectorXd& mass, const Eigen::MatrixXd& damping,
            const Eigen::MatrixXd& stiffness);

  [[nodiscard]] int size() const noexcept { return size_; }

  /// Moves `state` = (x_1..x_n, v_1..v_n) by T/2^level under forces u + w t (n values each), t from
  /// the start of the step. `next` may not be `state`. Real-time safe.
  void step(int level, const double* state, const double* u, const double* w,
            double* next) const noexcept;

  /// No motion of the system oscillates faster than this [rad/s].
  [[nodiscard]] double maxFrequency() const noexcept { return max_frequency_; }

 private:
  int size_ = 0;
  double max_frequency_ = 0.0;
  std::vector<double> matrices_;  ///< kLevels blocks of 2n x 4n, row by row
};

/// Parts of a period: 2^31 of them, so that a set bit of the count is a LinearMap level.
[[nodiscard]] std::uint64_t countParts(double dt, double period) noexcept;
inline constexpr std::uint64_t kPartsPerPeriod = std::uint64_t{1} << (LinearMap::kLevels - 1);

}  // namespace tandem
