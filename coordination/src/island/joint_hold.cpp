#include "island/joint_hold.h"

#include <algorithm>
#include <cmath>

namespace tandem {

bool isSoft(const JointRow& row, double mobility) noexcept {
  constexpr double kFastest = 8e3;  // [1/s]
  if (row.law == JointLaw::kMotor || (row.stiffness == 0.0 && row.damping == 0.0)) return false;
  return row.stiffness * mobility < kFastest * kFastest && row.damping * mobility < kFastest;
}

double computeSpringForce(const JointRow& row, double speed) noexcept {
  if (row.law == JointLaw::kLimit && row.way >= 0.0) return 0.0;
  const double force = -(row.stiffness * row.way + row.damping * speed);
  return row.law == JointLaw::kLimit ? std::max(0.0, force) : force;
}

void RowMobility::add(const MassRoots& roots, const Six& along, const PlainVec& n,
                      const PlainVec& turn) noexcept {
  const double own = dot(along, along);
  speed += own;
  has_factors |= !roots.is_even;
  free += roots.is_even ? own : roots.findFreeMobility(n, turn);
}

void JointHold::setUp(JointMode mode_before, double force, double h) noexcept {
  mode = mode_before;
  const bool is_angular = row.n_W == Vec3::Zero();
  RowMobility mobility;
  const auto look = [&](const RigidMover* mover, const Vec3& turn_W) {
    if (!mover) return;
    const PlainVec n(row.n_W), turn(turn_W);
    mobility.add(mover->roots, mover->roots.scale(n, turn), n, turn);
    if (is_angular && mover->inverse_mass > 0.0) reach = std::sqrt(mover->radius_squared);
  };
  look(a, row.turn_a_W);
  look(b, row.turn_b_W);
  inverse = mobility.perImpulse();
  free_inverse = mobility.freed();
  const bool is_motor = row.law == JointLaw::kMotor;
  low = least = is_motor ? h * row.low : row.law == JointLaw::kLimit ? 0.0 : -HUGE_VAL;
  high = most = is_motor ? h * row.high : HUGE_VAL;
  held = impulse = steady = h * force;
  is_soft = isSoft(row, inverse);
  if (is_soft) low = high = least = most = held;
}

bool JointHold::isAnswered(double slip) const noexcept {
  if (held < low || held > high) return false;
  const double u = reach * (speed() - wanted);
  // At a bound the other sense is allowed.
  return (held == low || u < slip) && (held == high || u > -slip);
}

JointMode JointHold::findMode() const noexcept {
  if (is_soft) return JointMode::kIdle;
  switch (row.law) {
    case JointLaw::kLocked:
      return JointMode::kHolds;
    case JointLaw::kLimit:
      return steady > 0.0 || blow > 0.0 ? JointMode::kHolds : JointMode::kIdle;
    case JointLaw::kMotor:
      break;
  }
  if (steady <= least) return JointMode::kLow;
  return steady >= most ? JointMode::kHigh : JointMode::kHolds;
}

void JointHold::startBlow() noexcept {
  held = impulse = 0.0;
  wanted = 0.0;
  if (row.law == JointLaw::kMotor || is_soft) low = high = 0.0;
  if (row.law != JointLaw::kLimit || is_soft) return;
  low = 0.0;
  high = is_impact || steady > 0.0 ? HUGE_VAL : 0.0;
  if (is_impact) wanted = std::max(0.0, -row.bounce * speed());
}

void JointHold::endBlow() noexcept { blow = impulse; }

void setDirection(const JointRow& row, const RigidMover* a, const RigidMover* b, int i,
                  ContactJacobian& J) noexcept {
  const PlainVec n(row.n_W);
  if (a) J.of_a[i] = a->roots.scale(n, PlainVec(row.turn_a_W));
  if (b) (a ? J.of_b : J.of_a)[i] = b->roots.scale(-1.0 * n, PlainVec(row.turn_b_W));
}

}  // namespace tandem
