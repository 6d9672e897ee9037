#pragma once

#include <vector>

namespace tandem {

/// The same motion as LinearMap's, M x'' + C x' + S x = u + w t, for matrices that change from step
/// to step: the power series of x(t), without anything built beforehand. It costs a few times what
/// a LinearMap does, and nothing to change.
class LinearSeries {
 public:
  /// Allocates. All matrices start as zero, all inverse masses, too.
  explicit LinearSeries(std::size_t size = 0);

  /// One over the mass; 0 holds the degree of freedom where it is, if its velocity is 0.
  void setInverseMass(std::size_t i, double value) noexcept { inverse_mass_[i] = value; }
  void clearMatrices() noexcept;
  /// Adds a spring and a damper to the ground, or between two degrees of freedom.
  void tie(std::size_t i, double stiffness, double damping) noexcept;
  void tie(std::size_t i, std::size_t j, double stiffness, double damping) noexcept;

  /// Moves `state` = (x_1..x_n, v_1..v_n) by `h` [s] under forces u + w t. `next` may not be
  /// `state`. Right to rounding while no decay is faster than 1e-7 s per step of 1 ms. Real-time
  /// safe.
  void step(double h, const double* state, const double* u, const double* w, double* next) noexcept;

 private:
  void takePart(double h, double t, const double* u, const double* w, double* state) noexcept;

  std::size_t size_;
  std::vector<double> inverse_mass_;
  std::vector<double> stiffness_, damping_;  ///< row by row
  std::vector<double> term_, next_term_, further_term_, x_, hv_;
};

}  // namespace tandem
