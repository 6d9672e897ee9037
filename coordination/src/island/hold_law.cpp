#include "island/hold_law.h"

#include <algorithm>
#include <cmath>

namespace tandem {

void HoldLaw::add(JointHold& next, ContactJacobian& J, double stiffness) noexcept {
  const int i = count++;
  hold[i] = &next;
  setDirection(next.row, next.a, next.b, i, J);
  u[i] = next.speed() - next.wanted;
  P0[i] = next.impulse;
  const double mobility = J.mobility(i);
  rho[i] = mobility > 0.0 ? stiffness / std::max(mobility, next.free_inverse) : 0.0;
  mode[i] = Mode::kBetween;
}

void HoldLaw::choose(bool& has_changed, bool& is_forced) noexcept {
  double stiffness[3] = {};
  for (int i = 0; i < count; ++i) {
    const double low = hold[i]->low, high = hold[i]->high;
    const double q = P0[i] - rho[i] * u[i];
    Mode next = q < low ? Mode::kLow : q > high ? Mode::kHigh : Mode::kBetween;
    if (!(low < high)) next = Mode::kLow;
    const bool leaps = next != mode[i] && next != Mode::kBetween && mode[i] != Mode::kBetween;
    if (leaps) next = Mode::kBetween;
    is_forced |= leaps;
    has_changed |= next != mode[i];
    mode[i] = next;
    P[i] = next == Mode::kBetween ? q : next == Mode::kLow ? low : high;
    if (next == Mode::kBetween) stiffness[i] = rho[i];
  }
  D = {};
  D.nn = stiffness[0];
  D.ss = stiffness[1];
  D.tt = stiffness[2];
}

bool HoldLaw::leaveMotorsOut() noexcept {
  bool has_changed = false;
  for (int i = 0; i < count; ++i) {
    if (hold[i]->row.law != JointLaw::kMotor) continue;
    has_changed |= stiffness(i) != 0.0;
    (i == 0 ? D.nn : i == 1 ? D.ss : D.tt) = 0.0;
  }
  return has_changed;
}

RigidRow::Local HoldLaw::held() const noexcept {
  double held[3] = {};
  for (int i = 0; i < count; ++i) held[i] = hold[i]->held;
  return {held[0], held[1], held[2]};
}

RigidRow::Local HoldLaw::missing() const noexcept {
  return RigidRow::Local{P[0], P[1], P[2]} - held();
}

double HoldLaw::slip() const noexcept {
  double most = 0.0;
  for (int i = 0; i < count; ++i)
    if (stiffness(i) > 0.0) most = std::max(most, hold[i]->reach * std::abs(u[i]));
  return most;
}

void HoldLaw::finish() noexcept {
  for (int i = 0; i < count; ++i) {
    hold[i]->apply(P[i] - hold[i]->held);
    hold[i]->impulse = P[i];
  }
}

}  // namespace tandem
