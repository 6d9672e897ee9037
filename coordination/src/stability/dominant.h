#pragma once

#include <complex>

#include <Eigen/Core>

namespace tandem::stability {

/// The largest eigenvalue of a matrix, to 1e-11 of it; of a pair the one above the real axis. Large
/// matrices of which few eigenvalues are large, such as those of packets on their way, take a small
/// part of the time of all eigenvalues.
[[nodiscard]] std::complex<double> computeDominant(const Eigen::MatrixXd& matrix);

/// The eigenvector of an eigenvalue, which is known as well as computeDominant() gives it.
[[nodiscard]] Eigen::VectorXcd computeEigenvector(const Eigen::MatrixXd& matrix,
                                                  std::complex<double> eigenvalue);

}  // namespace tandem::stability
