#pragma once

#include <cstdint>
#include <vector>

#include "island/contact_finder.h"
#include "island/overlap_allowance.h"
#include "island/rigid_row.h"
#include "island/touch.h"

namespace tandem {

/// Keeps rigid bodies out of each other over one inner step: sequential impulses with Coulomb
/// friction at the contacts found at the end of the step's smooth motion.
///
/// What a contact gave in one step acts as a force in the smooth motion of the next, and only the
/// change is solved for: a cube pressed against a wall stands still also for the damper that
/// presses it. The change P acts at the moment at which the contact closes, a share gamma of the
/// step h before its end:
///
///   gamma = d / (h u)     d: distance, u: normal velocity, both at the end of the smooth motion
///   v += P / m,   p += gamma h P / m
///
/// For an impact gamma h is the time since the moment itself; in a contact that lasts gamma is 1/2,
/// as for any change of a force. So a body at rest under a steady force neither sinks nor creeps
/// nor bounces. Overlap that rounding leaves is moved out of positions only, at a limited speed;
/// see OverlapAllowance for the host's.
class RigidStep {
 public:
  /// Allocates.
  RigidStep(std::size_t body_count, std::size_t contact_capacity);

  /// Start of a step: what contacts gave in the last one, as forces on the bodies.
  void holdForces(const States& before) noexcept;
  /// The forces held during this step, by body, in W.
  [[nodiscard]] const std::vector<Wrench>& heldForces() const noexcept { return held_; }

  /// Corrects `after`, where smooth motion under the held forces leads in `h` [s] from `before`.
  /// Returns false if the held forces were far from what the step came out with: done again from
  /// `before`, it is held by what was learnt, and better. Real-time safe.
  bool correct(const IslandModel& model, ContactFinder& finder, const States& before, double h,
               States& after) noexcept;

  /// The next step does not follow the last one.
  void forget() noexcept;

  /// Contact points solved so far, and how often each was relaxed, in all.
  [[nodiscard]] std::uint64_t points() const noexcept { return point_count_; }
  [[nodiscard]] std::uint64_t relaxations() const noexcept { return relaxation_count_; }

 private:
  struct Point {
    RigidContact contact;
    RigidRow row;
    double gamma = 0.5;
    double distance = 0.0;      ///< above the overlap that the pair may keep
    double aim_distance = 0.0;  ///< to which overlap moves out in this step
    double shift = 0.0;         ///< impulse times time, out of overlap
    bool lasts = false;         ///< no impact: the next step's impulse will be much the same
    RigidRow::Local held;       ///< impulse which the smooth motion has had
  };
  /// What a point leaves to its successor in the next step.
  struct Known {
    BodyIndex a, b;
    Vec3 p_W, f_W;
    bool taken;
  };

  /// Bodies that touch each other, and the points between them.
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
  std::vector<int> group_of_;          ///< by body: another of its group, or itself
  std::vector<std::size_t> place_of_;  ///< by body that stands for a group: its place in groups_
  std::vector<RigidRow*> rows_;        ///< group by group
  std::vector<BodyIndex> members_;     ///< bodies, group by group
  std::vector<Known> known_;
  std::vector<Wrench> held_;  ///< by body
  OverlapAllowance allowance_;
  std::uint64_t point_count_ = 0, relaxation_count_ = 0;
};

}  // namespace tandem
