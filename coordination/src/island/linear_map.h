#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace tandem {

/// Exact motion of n coupled degrees of freedom under forces that are linear in time:
///
///   M x'' + C x' + S x = u + w t
///
/// The state after a step h is one matrix times (x, v, u, w), from the exponential of the augmented
/// system. Matrices are built once for a period T and its binary fractions T/2^k. Any time in the
/// period thus takes a few products, and binary descent locates events.
class LinearMap {
 public:
  /// The smallest fraction is T/2^31: for T = 1 ms, 4.7e-13 s.
  static constexpr int kLevels = 32;

  LinearMap() = default;

  /// `mass` is the diagonal of M, positive. Allocates.
  LinearMap(double period, const Eigen::VectorXd& mass, const Eigen::MatrixXd& damping,
            const Eigen::MatrixXd& stiffness);

  [[nodiscard]] int size() const noexcept { return size_; }

  /// Moves `state` = (x_1..x_n, v_1..v_n) by T/2^level under forces u + w t (n values each). t
  /// starts at 0 with the step. `next` must not alias `state`. Real-time safe.
  void step(int level, const double* state, const double* u, const double* w,
            double* next) const noexcept;

  /// Upper bound of the system's oscillation frequencies [rad/s].
  [[nodiscard]] double maxFrequency() const noexcept { return max_frequency_; }

 private:
  int size_ = 0;
  double max_frequency_ = 0.0;
  std::vector<double> matrices_;  ///< kLevels blocks of 2n x 4n, row by row
};

/// Number of parts in `dt`; a period has 2^31, so each set bit is a LinearMap level.
[[nodiscard]] std::uint64_t countParts(double dt, double period) noexcept;
inline constexpr std::uint64_t kPartsPerPeriod = std::uint64_t{1} << (LinearMap::kLevels - 1);

}  // namespace tandem
