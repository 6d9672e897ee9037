#include "island/impulse_sweeps.h"

#include <algorithm>
#include <cmath>

namespace tandem {
namespace {

/// Sweeps end when no velocity changes by more [m/s]; small groups may take more of them.
constexpr double kPatientTolerance = 1e-9, kImpatientTolerance = 1e-6;
constexpr std::size_t kPatientRelaxations = 400;
constexpr int kMaxSweeps = 30;
/// Speed that sweeps may give, or this multiple of what bodies had [m/s]. Rows that are nearly
/// singular, as of a joint between bodies that must go apart, ask for any impulse.
constexpr double kMostSpeed = 100.0, kMostGain = 3.0;

/// Largest change of a body's velocity since the last call [m/s]. Points may still share a load
/// differently without it: four corners can do so in many ways.
double measureChange(const ContactGroups::Group& group) noexcept {
  double change = 0.0;
  for (std::size_t i = 0; i < group.mover_count; ++i) {
    RigidMover& mover = *group.movers[i];
    const PlainVec dv = mover.v - mover.v_last, dw = mover.w - mover.w_last;
    change = std::max(change, mover.squareOf(dv, dw));
    mover.v_last = mover.v;
    mover.w_last = mover.w;
  }
  return std::sqrt(change);
}

/// Greatest speed of a body [m/s].
double measureSpeed(const ContactGroups::Group& group) noexcept {
  double most = 0.0;
  for (std::size_t i = 0; i < group.mover_count; ++i) {
    const double square = group.movers[i]->squareOf(group.movers[i]->v, group.movers[i]->w);
    if (!(square <= most)) most = square;
  }
  return std::sqrt(most);
}

void keepHeld(const ContactGroups::Group& group) noexcept {
  for (std::size_t i = 0; i < group.mover_count; ++i) {
    group.movers[i]->v_held = group.movers[i]->v;
    group.movers[i]->w_held = group.movers[i]->w;
  }
}

/// Leaves the group what it held.
void takeBack(const ContactGroups::Group& group) noexcept {
  for (std::size_t i = 0; i < group.mover_count; ++i) {
    group.movers[i]->v = group.movers[i]->v_held;
    group.movers[i]->w = group.movers[i]->w_held;
  }
  for (std::size_t i = 0; i < group.row_count; ++i) {
    group.rows[i]->impulse = group.rows[i]->held;
    group.rows[i]->twist = group.rows[i]->twist_held;
  }
  for (std::size_t i = 0; i < group.hold_count; ++i) group.holds[i]->impulse = group.holds[i]->held;
}

RigidRow::Mode findMode(const RigidRow& row) noexcept {
  const RigidRow::Local& P = row.impulse;
  if (!(P.n > 0.0)) return RigidRow::Mode::kOpen;
  const double limit = (1.0 - 1e-9) * row.friction * P.n;
  return std::hypot(P.s, P.t) < limit ? RigidRow::Mode::kStick : RigidRow::Mode::kSlide;
}

}  // namespace

std::size_t sweepImpulses(const ContactGroups::Group& group) noexcept {
  const std::size_t count = group.row_count + group.hold_count;
  const auto patient_sweeps = static_cast<int>(kPatientRelaxations / count);
  (void)measureChange(group);
  const double most = std::max(kMostSpeed, kMostGain * measureSpeed(group));
  keepHeld(group);
  RigidRow* const* const end = group.rows + group.row_count;
  // Velocities have only what was held. Impulses that they lack would be taken back from nothing.
  for (auto row = group.rows; row != end; ++row) {
    (*row)->prepareSweeps();
    (*row)->apply((*row)->impulse - (*row)->held);
    (*row)->applyTwist((*row)->twist - (*row)->twist_held);
  }
  int sweeps = 0;
  while (sweeps < kMaxSweeps) {
    for (auto hold = group.holds; hold != group.holds + group.hold_count; ++hold) (*hold)->solve();
    // Alternate the direction, so that a change at one end of a row reaches the other in one sweep.
    if (sweeps % 2 == 0) {
      for (auto row = group.rows; row != end; ++row) (*row)->solve();
    } else {
      for (auto row = end; row != group.rows;) (*--row)->solve();
    }
    const bool is_patient = sweeps++ < patient_sweeps;
    if (measureChange(group) < (is_patient ? kPatientTolerance : kImpatientTolerance)) break;
  }
  // The next step begins with these modes.
  for (auto row = group.rows; row != end; ++row) {
    (*row)->mode = findMode(**row);
    (*row)->is_swept = true;
    (*row)->slide = {0.0, (*row)->velocityAlong(1), (*row)->velocityAlong(2)};
  }
  if (!(measureSpeed(group) <= most)) takeBack(group);
  return static_cast<std::size_t>(sweeps) * count;
}

}  // namespace tandem
