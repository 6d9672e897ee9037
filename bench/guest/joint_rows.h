#pragma once

#include <vector>

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

namespace tandem::demos::bench {

/// How a solver closes joints.
struct TearRates {
  double steps = 1.0;  ///< per second [1/s]
  double erp = 1.0;    ///< part of an error that a step corrects
  int iterations = 10;
};

/// A row as Bullet writes it. It reads axes as vectors of four.
struct alignas(32) JointLine {
  btScalar way_a[4] = {}, turn_a[4] = {}, way_b[4] = {}, turn_b[4] = {};
  btScalar error = 0, cfm = 0, low = -SIMD_INFINITY, high = SIMD_INFINITY;
};

/// Asks a joint for its rows as Bullet's solver does, at the poses of its bodies.
[[nodiscard]] std::vector<JointLine> readRows(btTypedConstraint& joint, const TearRates& rates);

}  // namespace tandem::demos::bench
