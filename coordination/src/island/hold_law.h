#pragma once

#include "island/contact_law.h"
#include "island/joint_hold.h"

namespace tandem {

/// Up to three rows of a joint in ContactSolver. Each has the law of a multiplier P0 within the
/// bounds of its impulse:
///
///   P = min(max(P0 - rho u, low), high)
struct HoldLaw {
  /// The impulse is at a bound, or between them.
  enum class Mode { kLow, kBetween, kHigh };

  JointHold* hold[3] = {};
  int count = 0;
  Mode mode[3] = {};
  double u[3] = {};              ///< above the wanted speed
  double P0[3] = {}, P[3] = {};  ///< impulses
  double rho[3] = {};
  ContactStiffness D;

  /// True if a row of `joint` can be added.
  [[nodiscard]] bool hasRoomFor(const JointHold& next) const noexcept {
    return count < 3 && hold[0]->joint == next.joint;
  }
  /// Adds a row; `J.a` and `J.b` are set.
  void add(JointHold& next, ContactJacobian& J, double stiffness) noexcept;
  /// Chooses the modes that the present speeds ask for, and P and D by them. A row that would go
  /// from one bound to the other stops in between first, and is `is_forced`: Newton's steps would
  /// take a motor to and fro for ever.
  void choose(bool& has_changed, bool& is_forced) noexcept;
  [[nodiscard]] double stiffness(int i) const noexcept {
    return i == 0 ? D.nn : i == 1 ? D.ss : D.tt;
  }
  /// For positions, of which motors are no matter. True if D has changed.
  bool leaveMotorsOut() noexcept;
  /// Impulses that the velocities had before, and those that they lack.
  [[nodiscard]] RigidRow::Local held() const noexcept;
  [[nodiscard]] RigidRow::Local missing() const noexcept;
  /// Largest speed along a row that keeps its speed [m/s].
  [[nodiscard]] double slip() const noexcept;
  /// Applies the impulses, and writes them to the rows.
  void finish() noexcept;
};

}  // namespace tandem
