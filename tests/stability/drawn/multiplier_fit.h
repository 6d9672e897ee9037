#pragma once

#include <limits>

#include <Eigen/Core>

namespace tandem::test {

/// The growth of a signal of a linear system that repeats its law each period.
struct FittedGrowth {
  double rate = 0.0;  ///< of the motion that grows fastest [1/s]
  /// Of the rates of the whole signal and of a part of it [1/s].
  double spread = std::numeric_limits<double>::infinity();
  double residual = 0.0;  ///< of the fit, over the signal's size
  int modes = 0;          ///< that the signal shows; 0: it is too short to be fitted

  /// True if the rate is sure to a part `precision` of it.
  [[nodiscard]] bool isSure(double precision) const noexcept {
    return spread <= precision * (rate < 0.0 ? -rate : rate);
  }
};

/// Samples of a signal: a column for each tick.
struct Signal {
  Eigen::MatrixXd samples;
  int period = 1;            ///< of the law, in ticks
  double sample_rate = 1e3;  ///< [Hz]
  double memory = 0.0;       ///< a piece of this length tells all of the system's state [s]
  double noise = 1e-15;      ///< of each sample: rounding
};

/// Fits multipliers of a period. Pieces of the signal, a few periods apart, follow one small matrix
/// (dynamic mode decomposition). It is fitted in the directions in which the signal is more than
/// noise.
[[nodiscard]] FittedGrowth fitGrowth(const Signal& signal);

}  // namespace tandem::test
