#include "island/linear_series.h"

#include <algorithm>
#include <cmath>

namespace tandem {
namespace {

/// Terms of the series; the last is below 1e-18 of the first for the part lengths in use.
constexpr int kTerms = 18;
/// Most parts of a step.
constexpr double kMostParts = 16384.0;

}  // namespace

LinearSeries::LinearSeries(std::size_t size)
    : size_(size),
      inverse_mass_(size),
      stiffness_(size * size),
      damping_(size * size),
      term_(size),
      next_term_(size),
      further_term_(size),
      x_(size),
      hv_(size) {}

void LinearSeries::clearMatrices() noexcept {
  std::fill(stiffness_.begin(), stiffness_.end(), 0.0);
  std::fill(damping_.begin(), damping_.end(), 0.0);
}

void LinearSeries::tie(std::size_t i, double stiffness, double damping) noexcept {
  stiffness_[i * size_ + i] += stiffness;
  damping_[i * size_ + i] += damping;
}

void LinearSeries::tie(std::size_t i, std::size_t j, double stiffness, double damping) noexcept {
  tie(i, stiffness, damping);
  tie(j, stiffness, damping);
  for (const std::size_t place : {i * size_ + j, j * size_ + i}) {
    stiffness_[place] -= stiffness;
    damping_[place] -= damping;
  }
}

void LinearSeries::step(double h, const double* state, const double* u, const double* w,
                        double* next) noexcept {
  // The parts are so short that the terms fall from the first on.
  double decay = 0.0, square = 0.0;
  for (std::size_t i = 0; i < size_; ++i) {
    double row_decay = 0.0, row_square = 0.0;
    for (std::size_t j = 0; j < size_; ++j) {
      row_decay += std::abs(damping_[i * size_ + j]) * inverse_mass_[i];
      row_square += std::abs(stiffness_[i * size_ + j]) * inverse_mass_[i];
    }
    decay = std::max(decay, row_decay);
    square = std::max(square, row_square);
  }
  const double wanted = std::ceil(std::max(2.0 * decay * h, 2.0 * std::sqrt(square) * h));
  const double parts = std::clamp(wanted, 1.0, kMostParts);
  std::copy_n(state, 2 * size_, next);
  for (double part = 0; part < parts; ++part) takePart(h / parts, part * h / parts, u, w, next);
}

/// With d_k the k-th term of x's Taylor series over the part:
///
///   d_(k+2) = M^-1 [ h^2 (U_k - S d_k) / ((k+1)(k+2)) - h C d_(k+1) / (k+2) ]
///
/// U_0 is the force and U_1 its increase over the part.
void LinearSeries::takePart(double h, double t, const double* u, const double* w,
                            double* state) noexcept {
  for (std::size_t i = 0; i < size_; ++i) {
    term_[i] = state[i];
    next_term_[i] = h * state[size_ + i];
    x_[i] = 0.0;
    hv_[i] = next_term_[i];
  }
  for (int k = 0; k < kTerms; ++k) {
    for (std::size_t i = 0; i < size_; ++i) {
      double pull = k == 0 ? u[i] + w[i] * t : k == 1 ? w[i] * h : 0.0, drag = 0.0;
      for (std::size_t j = 0; j < size_; ++j) {
        pull -= stiffness_[i * size_ + j] * term_[j];
        drag += damping_[i * size_ + j] * next_term_[j];
      }
      further_term_[i] =
          inverse_mass_[i] * (h * h / ((k + 1.0) * (k + 2.0)) * pull - h / (k + 2.0) * drag);
    }
    for (std::size_t i = 0; i < size_; ++i) {
      x_[i] += next_term_[i];
      hv_[i] += (k + 2.0) * further_term_[i];
    }
    term_.swap(next_term_);
    next_term_.swap(further_term_);
  }
  for (std::size_t i = 0; i < size_; ++i) {
    state[i] += x_[i];
    state[size_ + i] = hv_[i] / h;
  }
}

}  // namespace tandem
