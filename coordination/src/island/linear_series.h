#pragma once

#include <vector>

namespace tandem {

/// Motion as in LinearMap, M x'' + C x' + S x = u + w t. The matrices may change at each step. It
/// sums the power series of x(t) and builds nothing in advance. A step costs a few times a
/// LinearMap's; a change of the matrices costs nothing.
class LinearSeries {
 public:
  /// Allocates. All matrices and inverse masses start at zero.
  explicit LinearSeries(std::size_t size = 0);

  /// Inverse mass [1/kg]; 0 holds the degree of freedom in place if its velocity is 0.
  void setInverseMass(std::size_t i, double value) noexcept { inverse_mass_[i] = value; }
  void clearMatrices() noexcept;
  /// Adds a spring and a damper to the ground, or between two degrees of freedom.
  void tie(std::size_t i, double stiffness, double damping) noexcept;
  void tie(std::size_t i, std::size_t j, double stiffness, double damping) noexcept;

  /// Moves `state` = (x_1..x_n, v_1..v_n) by `h` [s] under forces u + w t. `next` must not alias
  /// `state`. Exact to rounding for time constants above 1e-7 s in steps of 1 ms. Real-time safe.
  void step(double h, const double* state, const double* u, const double* w, double* next) noexcept;

 private:
  void takePart(double h, double t, const double* u, const double* w, double* state) noexcept;

  std::size_t size_;
  std::vector<double> inverse_mass_;
  std::vector<double> stiffness_, damping_;  ///< row by row
  std::vector<double> term_, next_term_, further_term_, x_, hv_;
};

}  // namespace tandem
