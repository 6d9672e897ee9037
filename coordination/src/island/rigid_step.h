#pragma once

#include <cstdint>
#include <vector>

#include "island/contact_finder.h"
#include "island/contact_groups.h"
#include "island/contact_memory.h"
#include "island/contact_solver.h"
#include "island/joint_forces.h"
#include "island/joint_hold.h"
#include "island/overlap_allowance.h"
#include "island/rigid_row.h"
#include "island/touch.h"

namespace tandem {

/// Most rigid contact points solved together.
inline constexpr std::size_t kMaxRigidContacts = 512;

// clang-format off
/// Keeps rigid bodies apart over a step, with Coulomb friction, and joined ones together.
///
///   forces expected of known contacts are held  ->  smooth motion over h  ->  contacts at its end
///     -> a new one closed within the step: an impact. Once more, up to its moment
///     -> only the CHANGE P of impulse is solved for:  v += P / m,  p += h/2 P / m
///     -> it is large: a force was not foreseen. Once more with what was learnt, or half as long
///     -> gaps of touching points are closed in positions
///     -> impacts act at the end, in no time
///
/// While a set of contacts lasts, and sticks or slides as before, a step may be as long as a tick,
/// and is of second order. Joints push within the smooth motion (JointForces): only their change by
/// contacts, limits and motors is left. A body at rest neither sinks nor creeps nor bounces. Overlap is moved
/// out of positions only, at a limited speed. OverlapAllowance handles the host's overlap.
// clang-format on
class RigidStep {
 public:
  /// Allocates.
  RigidStep(std::size_t body_count, std::size_t contact_capacity, std::size_t max_joints,
            JointForces& joints);

  /// Notes what is known before an advance.
  void mark() noexcept {
    knew_ = knows_;
    if (!knew_) return;
    memory_.mark();
    allowance_marked_ = allowance_;
  }
  /// The advance begins anew: what it has seen has not been.
  void goBack() noexcept {
    if (!knew_) return forget();
    knows_ = true;
    memory_.goBack();
    allowance_ = allowance_marked_;
  }
  /// Begins an advance of one step or several: its work is bounded.
  void startAdvance() noexcept { solver_.startAdvance(); }
  /// False once that work is done: steps are taken as they are.
  [[nodiscard]] bool hasWorkLeft() const noexcept { return solver_.hasWorkLeft(); }
  /// Joints answer impulses that the bodies got since the last advance: velocities that no joint
  /// allows change at once.
  void answerBlows(const IslandModel& model, States& states) noexcept;
  /// Begins a step, or repeats it with another length of `h` [s].
  void begin() noexcept;
  /// Turns the expected contact forces into forces on the bodies. A step that may not be repeated
  /// gets none: in a jam they may be wrong by any factor, and nothing would take that out. Nor does
  /// one in which they threw a body.
  void holdForces(const States& before, double h, bool may_repeat) noexcept;
  /// True if something of a contact is known.
  [[nodiscard]] bool knowsContacts() const noexcept { return !memory_.isEmpty(); }
  /// Forces held during this step, by body, in W.
  [[nodiscard]] const std::vector<HeldWrench>& heldForces() const noexcept { return held_; }

  /// Corrects `after`, the result of smooth motion under the held forces from `before` over `h`
  /// [s]. Returns h if the step is done, or else the length with which to repeat it from
  /// holdForces() on: if it `may_repeat`, and at least `shortest` unless an impact comes sooner.
  /// `has_kink`: a force of the smooth motion began or ended within it. Real-time safe.
  [[nodiscard]] double correct(const IslandModel& model, const States& before, double h,
                               double shortest, bool may_repeat, bool has_kink,
                               States& after) noexcept;
  /// After a correct() that is not done: whether the same length is to be tried again.
  [[nodiscard]] bool isDone() const noexcept { return is_done_; }

  /// Calls `visit(hold)` for each row of a joint in the last step.
  template <typename Visit>
  void visitHolds(Visit visit) const {
    for (const JointHold& hold : holds_) visit(hold);
  }

  /// All positions were shifted. Real-time safe.
  void shiftOrigin(const Vec3& offset_W) noexcept { memory_.shiftOrigin(offset_W); }
  /// Forgets the last step: the next one does not follow it.
  void forget() noexcept;

  /// Calls `visit(contact, impulse)` for each point of the last step with its impulse on body a, in
  /// W [N s].
  template <typename Visit>
  void visitPoints(Visit visit) const {
    for (const ContactPoint& point : points_)
      visit(point.contact,
            (point.row.toWorld(point.steady) + point.row.toWorld(point.blow)).toVec3());
  }

  /// Number of contact points solved so far, and of their relaxations.
  [[nodiscard]] std::uint64_t points() const noexcept { return point_count_; }
  [[nodiscard]] std::uint64_t relaxations() const noexcept { return relaxation_count_; }
  [[nodiscard]] std::uint64_t factorisations() const noexcept { return solver_.factorisations(); }

 private:
  /// Gap of a point, or way of a joint's row, that need not be closed [m].
  static constexpr double kClosed = 1e-12;
  /// Overlap that is tolerated, and gap that counts as contact [m].
  static constexpr double kSlop = 1e-9;
  /// Gap of a known point that is closed without a velocity [m]. Corners differ by rounding: to
  /// close each by a velocity would need several at once.
  static constexpr double kSmallGap = 2e-6;

  [[nodiscard]] RigidMover& mover(BodyIndex body) noexcept {
    return body == kStanding ? standing_ : movers_[static_cast<std::size_t>(body)];
  }
  void setUp(const IslandModel& model, const States& before, const States& after,
             double h) noexcept;
  [[nodiscard]] double distanceOf(const ContactPoint& point) const noexcept;
  [[nodiscard]] double findImpacts(double h) noexcept;
  [[nodiscard]] PlainVec wayOf(BodyIndex body, const RigidContact& contact,
                               const States& after) noexcept;
  void guessOpenPoints() noexcept;
  void anchor(ContactPoint& point, const States& after, double h) noexcept;
  void setUpJoints(const IslandModel& model, const States& before, const States& after,
                   double h) noexcept;
  [[nodiscard]] bool haveJointModesChanged() const noexcept;
  void learnJointModes() noexcept;
  void aim(double h) noexcept;
  void takeBackGone(const States& after, double h) noexcept;
  void solveSteady(double h) noexcept;
  [[nodiscard]] bool isAnswered(const ContactGroups::Group& group) const noexcept;
  [[nodiscard]] double measureChange(const States& after) const noexcept;
  [[nodiscard]] bool hasThrown(const States& after, double h) const noexcept;
  [[nodiscard]] bool hasUnknownForce() const noexcept;
  [[nodiscard]] double measureEvents() const noexcept;
  void closeGaps(const ContactGroups::Group& group, double h) noexcept;
  void solveImpacts() noexcept;
  [[nodiscard]] bool solve(const ContactGroups::Group& group) noexcept;
  void moveOutOfOverlap(double h) noexcept;
  void writeBack(States& after) noexcept;

  std::vector<RigidMover> movers_;  ///< by body
  RigidMover standing_;
  std::vector<RigidContact> contacts_;
  std::vector<ContactPoint> points_;
  std::vector<HeldWrench> held_;       ///< by body
  std::vector<RigidRow::Local> gaps_;  ///< working memory of closeGaps()
  std::vector<double> ways_;           ///< the same
  JointForces* joints_;
  std::vector<JointHold> holds_;
  std::vector<JointRow> joint_rows_;  ///< working memory of setUpJoints()
  ContactGroups groups_;
  ContactMemory memory_;
  ContactSolver solver_;
  OverlapAllowance allowance_, allowance_before_, allowance_marked_;
  bool knows_ = false;  ///< something of a last step
  bool knew_ = false;   ///< the same at mark()
  bool is_done_ = true;
  bool is_let_go_ = false;  ///< what was held threw a body: this step holds nothing
  int times_learned_ = 0;   ///< tries of this step with forces of its own
  int impact_tries_ = 0;    ///< tries that looked for the moment of an impact
  double latest_ = 0.0;     ///< shortest length found too long for an impact [s]
  std::uint64_t point_count_ = 0, relaxation_count_ = 0;
};

}  // namespace tandem
