#include "stability/dominant.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

// Arnoldi's iteration: an orthonormal basis V of v, A v, A^2 v, ... with A V = V H + r e^T. The
// eigenvalues of the small H are nearly those of A, the largest first. r bounds their error.

namespace tandem::stability {
namespace {

constexpr Eigen::Index kDense = 80;      // up to here all eigenvalues cost less
constexpr Eigen::Index kFirstSize = 48;  // of the basis
constexpr double kPrecision = 1e-11;
constexpr std::size_t kSettled = 4;  // largest eigenvalues that must be found

/// Any vector will do that is orthogonal to none of the eigenvectors.
Eigen::VectorXd makeStart(Eigen::Index size) {
  Eigen::VectorXd start(size);
  for (Eigen::Index i = 0; i < size; ++i)
    start(i) = std::sin(1.0 + 2.3 * static_cast<double>(i * i));
  return start.normalized();
}

std::complex<double> pickLargest(const Eigen::VectorXcd& values) {
  Eigen::Index largest = 0;
  values.cwiseAbs().maxCoeff(&largest);
  return {values(largest).real(), std::abs(values(largest).imag())};
}

std::complex<double> computeDense(const Eigen::MatrixXd& matrix) {
  return pickLargest(Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues());
}

/// Grows a basis step by step.
class Krylov {
 public:
  Krylov(const Eigen::MatrixXd& matrix, Eigen::Index most)
      : matrix_(matrix), basis_(matrix.rows(), most + 1), small_(most + 1, most) {
    small_.setZero();
    basis_.col(0) = makeStart(matrix.rows());
  }

  /// False if the basis holds all that the start leads to: then its eigenvalues are exact.
  bool grow() {
    Eigen::VectorXd next = matrix_ * basis_.col(size_);
    const double before = next.norm();
    const auto known = basis_.leftCols(size_ + 1);
    for (int twice = 0; twice < 2; ++twice) {
      const Eigen::VectorXd parts = known.transpose() * next;
      small_.col(size_).head(size_ + 1) += parts;
      next -= known * parts;
    }
    const double rest = next.norm();
    small_(size_ + 1, size_) = rest;
    ++size_;
    if (rest <= 1e-14 * before) return false;
    basis_.col(size_) = next / rest;
    return true;
  }

  [[nodiscard]] Eigen::Index size() const noexcept { return size_; }

  /// The largest eigenvalue, if the largest ones are found. `is_whole`: the basis is.
  [[nodiscard]] std::optional<std::complex<double>> find(bool is_whole) const {
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(small_.topLeftCorner(size_, size_));
    const std::complex<double> largest = pickLargest(solver.eigenvalues());
    if (is_whole) return largest;
    const Eigen::VectorXd sizes = solver.eigenvalues().cwiseAbs();
    std::vector<Eigen::Index> order;
    for (Eigen::Index i = 0; i < size_; ++i) order.push_back(i);
    std::sort(order.begin(), order.end(),
              [&](Eigen::Index a, Eigen::Index b) { return sizes(a) > sizes(b); });
    const double rest = small_(size_, size_ - 1);
    for (std::size_t k = 0; k < kSettled; ++k) {
      const double error = rest * std::abs(solver.eigenvectors()(size_ - 1, order[k]));
      if (error > (k == 0 ? kPrecision : 1e-3) * std::abs(largest)) return std::nullopt;
    }
    return largest;
  }

 private:
  const Eigen::MatrixXd& matrix_;
  Eigen::MatrixXd basis_, small_;
  Eigen::Index size_ = 0;
};

}  // namespace

std::complex<double> computeDominant(const Eigen::MatrixXd& matrix) {
  if (matrix.rows() <= kDense) return computeDense(matrix);
  const Eigen::Index most = matrix.rows() / 2;
  Krylov krylov(matrix, most);
  for (Eigen::Index size = kFirstSize; size <= most; size += size / 2) {
    bool is_open = true;
    while (is_open && krylov.size() < size) is_open = krylov.grow();
    if (const auto found = krylov.find(!is_open)) return *found;
  }
  return computeDense(matrix);
}

/// Inverse iteration: each step leaves 1e-11 of the other eigenvectors.
Eigen::VectorXcd computeEigenvector(const Eigen::MatrixXd& matrix,
                                    std::complex<double> eigenvalue) {
  constexpr int kSteps = 3;
  Eigen::MatrixXcd shifted = matrix.cast<std::complex<double>>();
  shifted.diagonal().array() -= eigenvalue * (1.0 + 1e-13);
  const Eigen::PartialPivLU<Eigen::MatrixXcd> solver(shifted);
  Eigen::VectorXcd vector = makeStart(matrix.rows()).cast<std::complex<double>>();
  for (int step = 0; step < kSteps; ++step) vector = solver.solve(vector).normalized();
  return vector;
}

}  // namespace tandem::stability
