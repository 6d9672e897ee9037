#include "bench/guest/joint_rows.h"

#include <algorithm>
#include <cstddef>

namespace tandem::demos::bench {
namespace {

constexpr int kMostRows = 24;

}  // namespace

std::vector<JointLine> readRows(btTypedConstraint& joint, const TearRates& rates) {
  static_assert(sizeof(JointLine) % sizeof(btScalar) == 0);
  std::vector<JointLine> lines(kMostRows);
  btTypedConstraint::btConstraintInfo1 count{};
  joint.getInfo1(&count);
  btTypedConstraint::btConstraintInfo2 info{};
  info.fps = static_cast<btScalar>(rates.steps);
  info.erp = static_cast<btScalar>(rates.erp);
  info.m_numIterations = rates.iterations;
  info.m_damping = 1;
  JointLine& first = lines.front();
  info.m_J1linearAxis = first.way_a;
  info.m_J1angularAxis = first.turn_a;
  info.m_J2linearAxis = first.way_b;
  info.m_J2angularAxis = first.turn_b;
  info.rowskip = static_cast<int>(sizeof(JointLine) / sizeof(btScalar));
  info.m_constraintError = &first.error;
  info.cfm = &first.cfm;
  info.m_lowerLimit = &first.low;
  info.m_upperLimit = &first.high;
  if (count.m_numConstraintRows > 0) joint.getInfo2(&info);
  lines.resize(static_cast<std::size_t>(std::clamp(count.m_numConstraintRows, 0, kMostRows)));
  return lines;
}

}  // namespace tandem::demos::bench
