#pragma once

#include <cstddef>
#include <vector>

#include "island/contact_factor.h"
#include "island/contact_law.h"
#include "island/hold_law.h"
#include "island/rigid_row.h"

namespace tandem {

/// Solves the impulses of a group of touching and joined bodies to their end, all at once.
///
/// The unknown is the change x of velocity of all bodies, in units in which each has mass and
/// inertia 1. Each point has the law of PointLaw, with multipliers P0 and slip u:
///
///   (1 + J^T D J) dx = J^T (P - P_held) - x,   D = -dP/du;   then P0 <- P, until u is 0
///
/// Modes (open, stick, slide) of the last step are tried first: a contact that lasts needs one
/// factorisation. The matrix is never singular, however many corners share a load. They share it
/// as they did before. A joint's row has the same law, with bounds of its impulse instead of a
/// cone: none if it is locked, 0 and none for a limit. Real-time safe after the constructor.
class ContactSolver {
 public:
  /// Allocates.
  ContactSolver(std::size_t max_bodies, std::size_t max_points, std::size_t max_holds = 0);

  /// Before an advance of the island: its work is bounded.
  void startAdvance() noexcept { work_left_ = kMaxWork; }
  /// False once the work of this advance is done: groups that need new factors are left to sweeps.
  [[nodiscard]] bool hasWorkLeft() const noexcept { return work_left_ > 0; }
  /// Before the groups of a step: each is likely to be what it was in the step before.
  void begin() noexcept { next_factor_ = 0; }
  /// Before the groups of impacts, which do not last.
  void beginImpacts() noexcept { next_factor_ = factors_.size() - 1; }

  /// Solves the rows from their impulses, of which the movers have `held` already. Writes impulses
  /// and modes, and moves on the movers' velocities. False: modes have not settled, there are too
  /// many bodies, or the answer throws them. Then the rows are unchanged.
  [[nodiscard]] bool solve(RigidRow* const* rows, std::size_t row_count, RigidMover* const* movers,
                           std::size_t mover_count, JointHold* const* holds = nullptr,
                           std::size_t hold_count = 0) noexcept;

  /// After solve(). Shifts the movers' poses so that each pushing point moves by `-gap` [m] along
  /// its normal and, if it sticks, its tangents. `gaps` is by row. Rows of joints that hold move by
  /// `-ways`, by hold.
  void repair(const std::vector<RigidRow::Local>& gaps, const std::vector<double>& ways) noexcept;

  [[nodiscard]] std::uint64_t factorisations() const noexcept { return factorisation_count_; }

 private:
  /// Bodies whose blocks are factorised in an advance, about a microsecond each.
  static constexpr int kMaxWork = 2048;
  /// Factors for a group: of all its points, and of its normals and sticking tangents.
  struct Factors {
    GroupShape shape;
    ContactFactor whole, positions;
  };
  struct Modes {
    bool have_changed = false;
    bool are_forced = false;  ///< some are not those of the present velocities
  };

  void orderBodies(RigidMover* const* movers, std::size_t mover_count) noexcept;
  void setUp() noexcept;
  [[nodiscard]] bool settle() noexcept;
  void soften() noexcept;
  void updateMultipliers() noexcept;
  void setUpPoint(std::size_t point) noexcept;
  void setUpTwist(std::size_t twist) noexcept;
  void setUpHolds() noexcept;
  [[nodiscard]] std::size_t firstHold() const noexcept { return points_.size() + twists_.size(); }
  void shapeMatrix() noexcept;
  void respond(std::size_t twist) noexcept;
  void gatherStiffness() noexcept;
  void addPush(const ContactJacobian& J, const RigidRow::Local& push) noexcept;
  void addMotion(const ContactJacobian& J, RigidRow::Local& velocity) const noexcept;
  Modes chooseModes() noexcept;
  [[nodiscard]] bool factorise() noexcept;
  void step() noexcept;
  double measureResidual() noexcept;
  [[nodiscard]] double measureLargest(const std::vector<Six>& changes) const noexcept;
  [[nodiscard]] double measureSlip() const noexcept;
  [[nodiscard]] double measureHoldSlip() const noexcept;
  void addMotions() noexcept;
  [[nodiscard]] bool isThrow() noexcept;
  void keepAnswer() noexcept;
  void takeAnswer() noexcept;
  void finish() noexcept;

  std::vector<RigidMover*> bodies_;  ///< by block row
  std::vector<int> first_;
  std::vector<RigidRow*> rows_;        ///< by point
  std::vector<PointLaw> points_;       ///< by point
  std::vector<std::size_t> point_of_;  ///< by twist
  std::vector<TwistLaw> twists_;       ///< by twist
  std::vector<JointHold*> holds_;
  std::vector<HoldLaw> hold_laws_;
  bool has_answer_ = false;
  std::vector<PointLaw> answer_;  ///< nearly settled
  std::vector<TwistLaw> twist_answer_;
  std::vector<HoldLaw> hold_answer_;
  std::vector<ContactJacobian> J_;   ///< of points, then of twists, then of joints
  std::vector<ContactStiffness> D_;  ///< the same
  std::vector<Factors> factors_;     ///< by group; the last for impacts and many groups
  std::size_t next_factor_ = 0;
  Factors* factor_ = nullptr;  ///< of the present group
  std::vector<Six> x_, dx_;
  std::uint64_t factorisation_count_ = 0;
  int work_left_ = kMaxWork;
};

}  // namespace tandem
