#pragma once

#include <cmath>
#include <vector>

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include "tandem/coordination/types.h"

namespace tandem::test {

/// A row as Bullet gives it.
struct HostRow {
  Vec3 n, turn_a, turn_b;
  double error, low, high;
};

/// Asks a joint for its rows as Bullet's solver does, at the poses of its bodies.
inline std::vector<HostRow> askBullet(btTypedConstraint& joint, double fps, double erp) {
  struct Line {
    btScalar n1[4], turn1[4], n2[4], turn2[4], error, cfm, low, high;
  };
  std::vector<Line> lines(24, Line{});
  for (Line& line : lines) line.low = -SIMD_INFINITY, line.high = SIMD_INFINITY;
  btTypedConstraint::btConstraintInfo1 info1{};
  joint.getInfo1(&info1);
  btTypedConstraint::btConstraintInfo2 info2{};
  info2.fps = static_cast<btScalar>(fps);
  info2.erp = static_cast<btScalar>(erp);
  info2.m_numIterations = 10;
  Line& first = lines.front();
  info2.m_J1linearAxis = first.n1;
  info2.m_J1angularAxis = first.turn1;
  info2.m_J2linearAxis = first.n2;
  info2.m_J2angularAxis = first.turn2;
  info2.rowskip = sizeof(Line) / sizeof(btScalar);
  info2.m_constraintError = &first.error;
  info2.cfm = &first.cfm;
  info2.m_lowerLimit = &first.low;
  info2.m_upperLimit = &first.high;
  joint.getInfo2(&info2);
  std::vector<HostRow> rows;
  const auto vector = [](const btScalar* x) { return Vec3(x[0], x[1], x[2]); };
  for (int i = 0; i < info1.m_numConstraintRows; ++i) {
    const Line& line = lines[static_cast<std::size_t>(i)];
    rows.push_back(
        {vector(line.n1), vector(line.turn1), vector(line.turn2), line.error, line.low, line.high});
  }
  return rows;
}

inline bool isUnbounded(double bound) { return std::abs(bound) > 1e15; }

}  // namespace tandem::test
