#include "stability/drawn/multiplier_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

namespace tandem::test {
namespace {

constexpr double kPiece = 0.1;      // length of a piece of the signal, at least [s]
constexpr double kPieceTicks = 48;  // and
constexpr double kStride = 0.02;    // from one piece to the next, at least [s]
// Least sizes of a direction, over the largest one. The fit that changes least counts.
constexpr double kLeastSizes[] = {1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4};
constexpr double kLeastShare = 1e-5;  // of a mode in the signal's end
constexpr Eigen::Index kMostPieces = 300;
constexpr Eigen::Index kFewestPieces = 8;
constexpr Eigen::Index kMostInPiece = 150;  // samples of a piece, spread over it

struct Pieces {
  Eigen::MatrixXd columns;
  double stride = 0.0;  // [s]
  double noise = 0.0;   // of a column
};

/// A multiple of the period that lasts at least `time`.
Eigen::Index roundUp(double time, const Signal& signal) {
  const double periods = std::ceil(time * signal.sample_rate / signal.period - 1e-9);
  return signal.period * static_cast<Eigen::Index>(std::max(1.0, periods));
}

Pieces cut(const Signal& signal) {
  const Eigen::MatrixXd& samples = signal.samples;
  const double wanted = std::max({kPiece, kPieceTicks / signal.sample_rate, signal.memory});
  const Eigen::Index length = roundUp(wanted, signal);
  const double duration = static_cast<double>(samples.cols()) / signal.sample_rate;
  const Eigen::Index stride = roundUp(std::max(kStride, duration / kMostPieces), signal);
  const Eigen::Index count = std::max<Eigen::Index>(0, (samples.cols() - length) / stride + 1);
  const Eigen::Index taken = std::min(length, kMostInPiece), rows = samples.rows();
  Pieces pieces{Eigen::MatrixXd(rows * taken, count),
                static_cast<double>(stride) / signal.sample_rate,
                signal.noise * std::sqrt(static_cast<double>(rows * taken))};
  for (Eigen::Index k = 0; k < count; ++k)
    for (Eigen::Index i = 0; i < taken; ++i)
      pieces.columns.block(rows * i, k, rows, 1) = samples.col(k * stride + i * length / taken);
  return pieces;
}

/// Singular values and vectors of all pieces but the last, whose sizes `rate` evens out.
class EvenPieces {
 public:
  EvenPieces(const Pieces& pieces, double rate)
      : stride_(pieces.stride), rate_(rate), even_(pieces.columns) {
    for (Eigen::Index k = 0; k < even_.cols(); ++k) {
      const double scale = std::exp(-rate * stride_ * static_cast<double>(k));
      even_.col(k) *= scale;
      noise_ = std::hypot(noise_, scale * pieces.noise);
    }
    svd_.compute(even_.leftCols(even_.cols() - 1), Eigen::ComputeThinU | Eigen::ComputeThinV);
  }

  /// Fits the matrix that leads each piece to the next, in directions of at least a size.
  [[nodiscard]] FittedGrowth fit(double least_size) const {
    const Eigen::VectorXd& sizes = svd_.singularValues();
    const double least = std::max(noise_, least_size * sizes(0));
    Eigen::Index rank = 1;
    while (rank < sizes.size() / 2 && sizes(rank) > least) ++rank;
    const Eigen::Index count = even_.cols() - 1;
    const Eigen::MatrixXd U = svd_.matrixU().leftCols(rank);
    const Eigen::MatrixXd before = U.transpose() * even_.leftCols(count);
    const Eigen::MatrixXd after = U.transpose() * even_.rightCols(count);
    const Eigen::MatrixXd law =
        after * svd_.matrixV().leftCols(rank) * sizes.head(rank).cwiseInverse().asDiagonal();
    FittedGrowth fit;
    fit.rate = rate_ + std::log(findLargest(law, after.rightCols(1))) / stride_;
    fit.residual = (after - law * before).norm() / after.norm();
    fit.modes = static_cast<int>(rank);
    return fit;
  }

 private:
  /// The largest eigenvalue of those that have a part in the end.
  [[nodiscard]] static double findLargest(const Eigen::MatrixXd& law, const Eigen::VectorXd& end) {
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(law);
    const Eigen::MatrixXcd modes = solver.eigenvectors();
    const Eigen::VectorXd parts =
        modes.partialPivLu().solve(end.cast<std::complex<double>>()).cwiseAbs();
    double largest = 0.0;
    for (Eigen::Index i = 0; i < parts.size(); ++i)
      if (parts(i) > kLeastShare * parts.maxCoeff())
        largest = std::max(largest, std::abs(solver.eigenvalues()(i)));
    return largest;
  }

  double stride_, rate_, noise_ = 0.0;
  Eigen::MatrixXd even_;
  Eigen::BDCSVD<Eigen::MatrixXd> svd_;
};

/// Growth of the pieces' size over their second half.
double estimateRate(const Pieces& pieces) {
  const Eigen::Index last = pieces.columns.cols() - 1;
  if (last < 1) return 0.0;
  const double growth = pieces.columns.col(last).norm() / pieces.columns.col(last / 2).norm();
  return std::log(growth) / (pieces.stride * static_cast<double>(last - last / 2));
}

}  // namespace

FittedGrowth fitGrowth(const Signal& signal) {
  const Pieces pieces = cut(signal);
  FittedGrowth best;
  best.rate = estimateRate(pieces);
  const Eigen::Index part = pieces.columns.cols() * 3 / 4;
  if (part < kFewestPieces) return best;
  const EvenPieces whole(pieces, best.rate);
  const EvenPieces later({pieces.columns.rightCols(part), pieces.stride, pieces.noise}, best.rate);
  for (const double least_size : kLeastSizes) {
    FittedGrowth fit = whole.fit(least_size);
    fit.spread = std::abs(later.fit(least_size).rate - fit.rate);
    if (fit.spread < best.spread) best = fit;
  }
  return best;
}

}  // namespace tandem::test
