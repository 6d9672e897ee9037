#pragma once

#include <cstdint>
#include <vector>

#include "island/contact_finder.h"
#include "island/overlap_allowance.h"
#include "island/rigid_row.h"
#include "island/touch.h"

namespace tandem {

/// Most rigid contact points solved together.
inline constexpr std::size_t kMaxRigidContacts = 512;

/// Keeps rigid bodies apart over one inner step. It applies sequential impulses with Coulomb
/// friction at the contacts found after the step's smooth motion.
///
/// A contact's impulse in one step acts as a force in the smooth motion of the next; only the
/// change is solved. A cube pressed against a wall thus keeps zero velocity, and the damper that
/// presses it sees no motion. The change P acts when the contact closes, a share gamma of the step
/// h before its end:
///
///   gamma = d / (h u)     d: distance, u: normal velocity, both at the end of the smooth motion
///   v += P / m,   p += gamma h P / m
///
/// For an impact, gamma h is the time since the impact. In a lasting contact gamma is 1/2, as for
/// any change of a force. A body at rest under a steady force thus neither sinks nor creeps nor
/// bounces. Overlap from rounding is moved out of positions only, at a limited speed.
/// OverlapAllowance handles the host's overlap.
class RigidStep {
 public:
  /// Allocates.
  RigidStep(std::size_t body_count, std::size_t contact_capacity);

  /// Starts a step: turns the contact impulses of the last step into forces on the bodies.
  void holdForces(const States& before) noexcept;
  /// Forces held during this step, by body, in W.
  [[nodiscard]] const std::vector<Wrench>& heldForces() const noexcept { return held_; }

  /// Corrects `after`, the result of smooth motion under the held forces from `before` over `h`
  /// [s]. Returns false if the held forces were far from the solution. Repeating the step from
  /// `before` then holds the new forces and is more accurate. Real-time safe.
  bool correct(const IslandModel& model, ContactFinder& finder, const States& before, double h,
               States& after) noexcept;

  /// All positions were shifted. Real-time safe.
  void shiftOrigin(const Vec3& offset_W) noexcept {
    for (Known& known : known_) known.p_W += offset_W;
  }
  /// Forgets the last step: the next one does not follow it.
  void forget() noexcept;

  /// Calls `visit(contact, impulse)` for each point of the last step with its impulse on body a, in
  /// W [N s].
  template <typename Visit>
  void visitPoints(Visit visit) const {
    for (const Point& point : points_)
      visit(point.contact, point.row.toWorld(point.row.impulse).toVec3());
  }

  /// Number of contact points solved so far, and of their relaxations.
  [[nodiscard]] std::uint64_t points() const noexcept { return point_count_; }
  [[nodiscard]] std::uint64_t relaxations() const noexcept { return relaxation_count_; }

 private:
  struct Point {
    RigidContact contact;
    RigidRow row;
    double gamma = 0.5;
    double distance = 0.0;      ///< distance above the overlap that the pair may keep [m]
    double aim_distance = 0.0;  ///< distance to which overlap moves out in this step [m]
    double shift = 0.0;         ///< impulse times time that moves out of overlap [N s^2]
    bool lasts = false;         ///< no impact: the next step's impulse will be similar
    RigidRow::Local held;       ///< impulse already applied in the smooth motion
  };
  /// Data of a point kept for the next step.
  struct Known {
    BodyIndex a, b;
    Vec3 p_W, f_W;
    bool taken;
  };

  /// A set of touching bodies, and the points between them.
  struct Group {
    std::size_t first_row = 0, row_count = 0, first_member = 0, member_count = 0;
  };

  [[nodiscard]] RigidMover& mover(BodyIndex body) noexcept {
    return body == kStanding ? standing_ : movers_[body];
  }
  void setUp(const IslandModel& model, const States& before, const States& after,
             double h) noexcept;
  void aim(double h, Point& point) noexcept;
  void startFromKnown(const States& after, double h) noexcept;
  void takeBack(BodyIndex body, const States& after, const Known& known, const Vec3& impulse_W,
                double h) noexcept;
  void groupPoints() noexcept;
  [[nodiscard]] int findGroup(BodyIndex body) noexcept;
  void solveVelocities() noexcept;
  void solve(const Group& group) noexcept;
  [[nodiscard]] double measureChange(const Group& group) noexcept;
  void sumShifts(double h) noexcept;
  void moveOutOfOverlap(double h) noexcept;
  void writeBack(States& after) noexcept;
  [[nodiscard]] bool wasForeseen() const noexcept;
  void keepKnown(double h) noexcept;

  std::vector<RigidMover> movers_;  ///< by body
  RigidMover standing_;
  std::vector<RigidContact> contacts_;
  std::vector<Point> points_;
  std::vector<Group> groups_;
  std::vector<int> group_of_;          ///< by body: another body of its group, or itself
  std::vector<std::size_t> place_of_;  ///< by lowest body of a group: index in groups_
  std::vector<RigidRow*> rows_;        ///< rows, group by group
  std::vector<BodyIndex> members_;     ///< bodies, group by group
  std::vector<Known> known_;
  std::vector<Wrench> held_;  ///< by body
  OverlapAllowance allowance_;
  std::uint64_t point_count_ = 0, relaxation_count_ = 0;
};

}  // namespace tandem
