#pragma once

#include <cmath>
#include <vector>

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include "tandem/coordination/types.h"

#include "bench/guest/joint_rows.h"

namespace tandem::test {

/// A row as Bullet gives it.
struct HostRow {
  Vec3 n, turn_a, turn_b;
  double error, low, high;
};

/// Asks a joint for its rows as Bullet's solver does, at the poses of its bodies.
inline std::vector<HostRow> askBullet(btTypedConstraint& joint, double fps, double erp) {
  std::vector<HostRow> rows;
  const auto vector = [](const btScalar* x) { return Vec3(x[0], x[1], x[2]); };
  for (const demos::bench::JointLine& line : demos::bench::readRows(joint, {fps, erp}))
    rows.push_back({vector(line.way_a), vector(line.turn_a), vector(line.turn_b), line.error,
                    line.low, line.high});
  return rows;
}

inline bool isUnbounded(double bound) { return std::abs(bound) > 1e15; }

}  // namespace tandem::test
