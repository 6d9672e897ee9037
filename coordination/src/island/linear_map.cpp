#include "island/linear_map.h"

#include <cmath>

#include <unsupported/Eigen/MatrixFunctions>

namespace tandem {

LinearMap::LinearMap(double period, const Eigen::VectorXd& mass, const Eigen::MatrixXd& damping,
                     const Eigen::MatrixXd& stiffness)
    : size_(static_cast<int>(mass.size())) {
  const Eigen::Index n = mass.size();
  const Eigen::MatrixXd inverse_mass = mass.cwiseInverse().asDiagonal();

  // z = (x, v, u, w):  x' = v,  v' = M^-1 (u - S x - C v),  u' = w,  w' = 0
  Eigen::MatrixXd generator = Eigen::MatrixXd::Zero(4 * n, 4 * n);
  generator.block(0, n, n, n).setIdentity();
  generator.block(n, 0, n, n) = -inverse_mass * stiffness;
  generator.block(n, n, n, n) = -inverse_mass * damping;
  generator.block(n, 2 * n, n, n) = inverse_mass;
  generator.block(2 * n, 3 * n, n, n).setIdentity();

  // Gershgorin's bound on the eigenvalues of M^-1/2 S M^-1/2, the squared undamped frequencies.
  const Eigen::MatrixXd scale = mass.cwiseInverse().cwiseSqrt().asDiagonal();
  max_frequency_ = std::sqrt((scale * stiffness * scale).cwiseAbs().rowwise().sum().maxCoeff());

  matrices_.reserve(static_cast<std::size_t>(kLevels * 8 * n * n));
  for (int level = 0; level < kLevels; ++level) {
    const Eigen::MatrixXd whole = (generator * std::ldexp(period, -level)).exp();
    for (Eigen::Index row = 0; row < 2 * n; ++row)
      for (Eigen::Index column = 0; column < 4 * n; ++column)
        matrices_.push_back(whole(row, column));
  }
}

namespace {

/// Product of a 2n x 4n matrix, row by row, with (state, u, w). The loops unroll when the compiler
/// knows `n`.
inline void multiply(int n, const double* row, const double* state, const double* u,
                     const double* w, double* next) noexcept {
  for (int i = 0; i < 2 * n; ++i, row += 4 * n) {
    double sum = 0.0;
    for (int j = 0; j < 2 * n; ++j) sum += row[j] * state[j];
    for (int j = 0; j < n; ++j) sum += row[2 * n + j] * u[j] + row[3 * n + j] * w[j];
    next[i] = sum;
  }
}

}  // namespace

void LinearMap::step(int level, const double* state, const double* u, const double* w,
                     double* next) const noexcept {
  const double* matrix = matrices_.data() + static_cast<std::ptrdiff_t>(level) * 8 * size_ * size_;
  switch (size_) {
    case 1:
      return multiply(1, matrix, state, u, w, next);
    case 2:
      return multiply(2, matrix, state, u, w, next);
    default:
      return multiply(size_, matrix, state, u, w, next);
  }
}

std::uint64_t countParts(double dt, double period) noexcept {
  const double parts = std::round(dt / period * static_cast<double>(kPartsPerPeriod));
  return parts <= 0.0 ? 0 : static_cast<std::uint64_t>(parts);
}

}  // namespace tandem
