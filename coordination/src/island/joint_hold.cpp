#include "island/joint_hold.h"

#include <cmath>

namespace tandem {

void JointHold::setUp(JointMode mode_before, double force, double h) noexcept {
  mode = mode_before;
  const bool is_angular = row.n_W == Vec3::Zero();
  const auto look = [&](const RigidMover* mover, const Vec3& turn_W) {
    if (!mover) return;
    const PlainVec n(row.n_W), turn(turn_W);
    inverse += dot(n, multiplyEach(mover->inverse_mass_W, n)) + dot(turn, mover->turnBy(turn));
    if (is_angular && mover->inverse_mass > 0.0) reach = std::sqrt(mover->radius_squared);
  };
  look(a, row.turn_a_W);
  look(b, row.turn_b_W);
  const bool is_motor = row.law == JointLaw::kMotor;
  low = least = is_motor ? h * row.low : row.law == JointLaw::kLimit ? 0.0 : -HUGE_VAL;
  high = most = is_motor ? h * row.high : HUGE_VAL;
  held = impulse = h * force;
}

JointMode JointHold::findMode() const noexcept {
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
  if (row.law == JointLaw::kMotor) low = high = 0.0;
  if (row.law != JointLaw::kLimit) return;
  low = 0.0;
  high = is_impact || steady > 0.0 ? HUGE_VAL : 0.0;
  if (is_impact) wanted = std::max(0.0, -row.bounce * speed());
}

void JointHold::endBlow() noexcept { blow = impulse; }

void setDirection(const JointRow& row, const RigidMover* a, const RigidMover* b, int i,
                  ContactJacobian& J) noexcept {
  const auto fill = [](const RigidMover& mover, const PlainVec& n, const PlainVec& turn,
                       Six& along) {
    multiplyEach(mover.root_mass_W, n).store(along.at);
    PlainVec(dot(mover.root_x, turn), dot(mover.root_y, turn), dot(mover.root_z, turn))
        .store(along.at + 3);
  };
  const PlainVec n(row.n_W);
  if (a) {
    fill(*a, n, PlainVec(row.turn_a_W), J.of_a[i]);
    if (b) fill(*b, -1.0 * n, PlainVec(row.turn_b_W), J.of_b[i]);
  } else if (b) {
    fill(*b, -1.0 * n, PlainVec(row.turn_b_W), J.of_a[i]);
  }
}

}  // namespace tandem
