#pragma once

#include <vector>

#include <Eigen/Cholesky>

#include "bench/reference/planar_scene.h"

namespace tandem::demos::bench {

/// The joints of a planar scene. What they lock is solved directly, so that it holds at the end of
/// a step to rounding (RATTLE, order 2). Limits and motors are rows of projected Gauss-Seidel.
///
/// The order of calls in a step is: look, warmStart, then solveLocks and sweep in turns, then the
/// positions move, and project ends the step.
class PlanarJoints {
 public:
  explicit PlanarJoints(const PlanarScene& scene);

  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] bool areJoined(const PlanarScene& scene, std::size_t a, std::size_t b) const;

  /// Reads the directions at the present poses, for a step of h [s].
  void look(const PlanarScene& scene, double h);
  /// Gives the impulses of the latest step again.
  void warmStart(PlanarScene& scene);
  /// Changes velocities so that nothing locked is off when the bodies have moved on by h [s].
  void solveLocks(PlanarScene& scene, double h);
  /// Relaxes limits and motors once. Returns the largest change of a rate [m/s or rad/s].
  double sweep(PlanarScene& scene, double h);
  /// Takes the locked rates out of the velocities at the present poses.
  void project(PlanarScene& scene);

  /// Coordinate of a joint [rad or m].
  [[nodiscard]] static double computeCoordinate(const PlanarScene& scene, const PlanarJoint& joint);

 private:
  /// Locked, locked, free.
  static constexpr Eigen::Index kRows = 3, kLocks = 2;

  using Directions = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  struct Impulses {
    double limit = 0.0, motor = 0.0;
  };

  void computeDirections(const PlanarScene& scene);
  void push(PlanarScene& scene, const Eigen::VectorXd& impulses) const;
  void push(PlanarScene& scene, std::size_t joint, double impulse) const;
  /// Mean rate of a joint's coordinate over the step [rad/s or m/s].
  [[nodiscard]] double computeRate(const PlanarScene& scene, std::size_t joint, double h) const;

  Eigen::Index count_;
  Directions directions_;           // of all coordinates by all velocities: x, y, turn of a body
  Directions locks_;                // of these, the locked ones
  Eigen::VectorXd inverse_masses_;  // of all velocities
  Eigen::VectorXd velocities_, errors_;
  Eigen::LLT<Eigen::MatrixXd> lock_masses_;
  Eigen::VectorXd lock_impulses_;  // of the latest step
  std::vector<Impulses> impulses_;
  std::vector<double> coordinates_;  // at the start of the step
};

}  // namespace tandem::demos::bench
