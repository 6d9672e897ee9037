#pragma once

#include <vector>

#include "bench/reference/planar_contact.h"
#include "bench/reference/planar_joints.h"

namespace tandem::demos::bench {

/// A solver for bodies in the plane: rigid contact with Coulomb friction by projected Gauss-Seidel
/// on velocities, restitution 0. Run it at a step so fine that its first order does not matter.
///
/// Leap-frog: half a kick of the smooth forces, rigid rows on the velocities in mid-step,
/// positions, half a kick. Smooth forces are gravity, couplers and compliant contact of tools. A
/// row lets a gap close in one step and no further. Existing overlap stays and is never pushed out,
/// so nothing bounces. Joints hold at the end of each step (PlanarJoints).
class PlanarSolver {
 public:
  explicit PlanarSolver(PlanarScene scene);

  /// Targets of tools may be set between steps.
  [[nodiscard]] PlanarScene& scene() { return scene_; }
  [[nodiscard]] const PlanarScene& scene() const { return scene_; }

  /// Advances by one step of h [s].
  void step(double h);

  /// Sum of the normal impulses of the latest step between bodies `a` and `b` [N s].
  [[nodiscard]] double normalImpulse(std::size_t a, std::size_t b) const;

 private:
  struct Row {
    std::size_t a, b;
    int feature;
    Vec2 normal, arm_a, arm_b;
    double gap, normal_mass, tangent_mass;
    double normal_impulse = 0.0, tangent_impulse = 0.0;
  };

  void findRows();
  void addRows(std::size_t a, std::size_t b, const PlanarManifold& manifold);
  void warmStart(Row& row) const;
  void applyImpulse(const Row& row, const Vec2& impulse);
  /// Sweeps once over all rows. Returns the largest change of a velocity [m/s].
  double sweep(double h);
  void computeForces();
  void kick(double h);
  void solveVelocities(double h);

  PlanarScene scene_;
  PlanarJoints joints_;
  std::vector<Row> rows_, old_rows_;
  std::vector<Vec2> tool_forces_, body_forces_;
  std::vector<double> body_torques_;
  std::vector<Vec2> tool_v_, body_v_;
  std::vector<double> body_w_;
};

}  // namespace tandem::demos::bench
