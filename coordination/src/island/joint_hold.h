#pragma once

#include <algorithm>

#include "island/contact_law.h"
#include "island/joint_memory.h"
#include "island/locked_axis.h"
#include "island/rigid_row.h"

namespace tandem {

/// A row of a joint while a step is solved. All speeds are along it.
struct JointHold {
  std::size_t joint = 0;
  BodyIndex body_a = kStanding, body_b = kStanding;
  JointRow row;
  RigidMover *a = nullptr, *b = nullptr;
  double inverse = 0.0;            ///< speed per impulse
  double free_inverse = 0.0;       ///< RowMobility::freed()
  double reach = 1.0;              ///< way of a part of the bodies per way along the row [1 or m]
  double opening = 0.0;            ///< speed at the start of the step
  double at_start = 0.0;           ///< way at that time, about
  bool is_impact = false;          ///< a limit that is reached at the end of the step
  double held = 0.0;               ///< impulse that the velocities have already
  double impulse = 0.0;            ///< total of this step
  double steady = 0.0;             ///< total without impacts at its end; before: what is held
  double blow = 0.0;               ///< of those impacts
  double wanted = 0.0;             ///< speed; a limit's least
  double low = 0.0, high = 0.0;    ///< bounds of the impulse
  double least = 0.0, most = 0.0;  ///< the same, of the step without impacts
  JointMode mode = JointMode::kHolds;
  bool is_soft = false;  ///< smooth motion has done all

  [[nodiscard]] bool isLimit() const noexcept { return row.law == JointLaw::kLimit && !is_soft; }
  [[nodiscard]] bool isLocked() const noexcept { return row.law == JointLaw::kLocked && !is_soft; }
  [[nodiscard]] double speed() const noexcept {
    double u = 0.0;
    if (a) u += dot(PlainVec(row.n_W), a->v) + dot(PlainVec(row.turn_a_W), a->w);
    if (b) u += dot(PlainVec(row.turn_b_W), b->w) - dot(PlainVec(row.n_W), b->v);
    return u;
  }
  /// Way that the shifts of this step have made.
  [[nodiscard]] double shifted() const noexcept {
    double way = 0.0;
    if (a) way += dot(PlainVec(row.n_W), a->shift) + dot(PlainVec(row.turn_a_W), a->turn);
    if (b) way += dot(PlainVec(row.turn_b_W), b->turn) - dot(PlainVec(row.n_W), b->shift);
    return way;
  }
  void apply(double change) noexcept {
    const PlainVec n = change * PlainVec(row.n_W);
    if (a) {
      a->v = a->v + multiplyEach(a->inverse_mass_W, n);
      a->w = a->w + change * a->turnBy(PlainVec(row.turn_a_W));
    }
    if (b) {
      b->v = b->v - multiplyEach(b->inverse_mass_W, n);
      b->w = b->w + change * b->turnBy(PlainVec(row.turn_b_W));
    }
  }
  /// Shifts the poses by an impulse times a time.
  void shift(double by) noexcept {
    const PlainVec n = by * PlainVec(row.n_W);
    if (a) {
      a->shift = a->shift + multiplyEach(a->inverse_mass_W, n);
      a->turn = a->turn + by * a->turnBy(PlainVec(row.turn_a_W));
    }
    if (b) {
      b->shift = b->shift - multiplyEach(b->inverse_mass_W, n);
      b->turn = b->turn + by * b->turnBy(PlainVec(row.turn_b_W));
    }
  }
  /// One relaxation, within the bounds of the impulse.
  void solve() noexcept {
    const double next = std::clamp(impulse + (wanted - speed()) / inverse, low, high);
    apply(next - impulse);
    impulse = next;
  }
  /// True if the impulse that the velocities have is the answer, but for `slip` [m/s].
  [[nodiscard]] bool isAnswered(double slip) const noexcept;
  /// After the ends are set. `force` is that of the smooth motion at the end of the step.
  void setUp(JointMode mode_before, double force, double h) noexcept;
  /// The mode that its impulse tells.
  [[nodiscard]] JointMode findMode() const noexcept;
  /// True if its way is to stay at 0.
  [[nodiscard]] bool keepsPlace() const noexcept {
    return row.law != JointLaw::kMotor && findMode() == JointMode::kHolds;
  }
  /// Between the impulses of the step and those at its end: motors have no part in these.
  void startBlow() noexcept;
  void endBlow() noexcept;
};

/// True if a spring and a damper hold the row, whose mobility is given [1/kg]. One that is faster
/// than anybody feels, or than integration follows, counts as rigid: it yields 25 nm under its
/// load.
[[nodiscard]] bool isSoft(const JointRow& row, double mobility) noexcept;
/// Force of a soft row that goes at `speed`.
[[nodiscard]] double computeSpringForce(const JointRow& row, double speed) noexcept;

/// Speed along a row per impulse, by both ends. Linear and angular factors may lock it, but for 6
/// degrees: isLocked(). Then it has none.
struct RowMobility {
  double speed = 0.0, free = 0.0;  ///< with factors, and without them
  bool has_factors = false;

  /// Adds an end. `along`: MassRoots::scale() of n and turn.
  void add(const MassRoots& roots, const Six& along, const PlainVec& n,
           const PlainVec& turn) noexcept;
  [[nodiscard]] double perImpulse() const noexcept {
    return has_factors && tandem::isLocked(speed, free) ? 0.0 : speed;
  }
  /// Weighs a row of ends with unequal factors; else 0. A host may move a body along locked axes as
  /// no joint allows. By its own mobility, a row that is nearly locked would have the most weight,
  /// and throw the bodies.
  [[nodiscard]] double freed() const noexcept { return has_factors ? free : 0.0; }
};

/// Writes the velocity along a joint's row into direction `i` of `J`, in units in which each end
/// has mass and inertia 1. An end without a block row is null; J.a stands for the first that is
/// not.
void setDirection(const JointRow& row, const RigidMover* a, const RigidMover* b, int i,
                  ContactJacobian& J) noexcept;

}  // namespace tandem
