#pragma once

#include <algorithm>
#include <vector>

#include "island/contact_finder.h"
#include "island/island_model.h"
#include "island/rigid_row.h"
#include "island/touch.h"

namespace tandem {

/// A contact point while a step is solved.
struct ContactPoint {
  RigidContact contact;
  RigidRow row;
  double at_start = 0.0;   ///< its distance at the start of the step, about [m]
  double opening = 0.0;    ///< speed at which it opens at the start of the step [m/s]
  bool stood = false;      ///< its bodies did not move beside each other at that time
  bool have_met = false;   ///< its bodies touched in the last step
  bool is_impact = false;  ///< it closes at the end of the step: its impulse takes no time
  RigidRow::Mode mode_before = RigidRow::Mode::kUnknown;  ///< in the last step
  int known = -1;                ///< index in ContactMemory of the point of the last step; -1: new
  double aim_distance = 0.0;     ///< to which overlap moves out in this step [m]
  double shift = 0.0;            ///< impulse times time that moves out of overlap [N s^2]
  RigidRow::Local steady;        ///< impulse of the step without impacts [N s]
  RigidRow::Local blow;          ///< impulse of impacts at its end [N s]
  RigidRow::Local steady_twist;  ///< the same against turning [N m s]
};

/// Calls `visit(first, last)` for the points of each pair of bodies, or of a body and a surface.
template <typename Visit>
void forEachPair(std::vector<ContactPoint>& points, Visit visit) {
  for (auto first = points.begin(); first != points.end();) {
    const auto last = std::find_if(first, points.end(), [&](const ContactPoint& point) {
      return !areOfOnePair(point.contact, first->contact);
    });
    visit(first, last);
    first = last;
  }
}

/// Contact points of the last step with their forces, and what they will be in the next.
///
/// A force is expected to go on at its rate of change, and its point and normal to move with the
/// body that they belong to. What is expected at the middle of a step acts on the bodies during
/// their smooth motion, and the solver finds the rest. A lasting contact is then of second order in
/// the step. All functions are real-time safe.
class ContactMemory {
 public:
  /// Allocates.
  explicit ContactMemory(std::size_t capacity);

  void forget() noexcept;
  /// Notes what is known before an advance, which may have to begin anew.
  void mark() noexcept { marked_ = known_; }
  void goBack() noexcept;
  void shiftOrigin(const Vec3& offset_W) noexcept;
  /// True if nothing is known, and nothing was held in the present try.
  [[nodiscard]] bool isEmpty() const noexcept { return known_.empty() && trial().empty(); }

  /// Adds the forces expected in a step of `h` [s] from `before` to `held`, by body.
  void hold(const States& before, double h, std::vector<HeldWrench>& held) noexcept;
  /// Holds nothing in the coming step: none of it could be corrected. Forces are first guesses
  /// then.
  void letGo() noexcept;
  /// Guesses nothing in this try, either.
  void forgetForces() noexcept;
  /// True if a point had a force in the last step, or has learned one.
  [[nodiscard]] bool hasForce(const ContactPoint& point) const noexcept {
    if (point.known < 0) return false;
    const Known& known = knownOf(point);
    return known.is_learned || known.last.age > 0;
  }
  /// True if a held force's point has gone.
  [[nodiscard]] bool hasGone() const noexcept {
    return std::any_of(held_.begin(), held_.end(), [](const Held& held) { return !held.is_taken; });
  }
  /// Place of a known point at the start of the step.
  [[nodiscard]] const PlainVec& startOf(const ContactPoint& point) const noexcept {
    return knownOf(point).p_W;
  }
  /// Finds each point among the known ones, and starts its row from what they had.
  void match(std::vector<ContactPoint>& points, double h) noexcept;
  /// Calls `visit(a, b, p_W, f_W, t_W)` for each held force whose point has gone.
  template <typename Visit>
  void visitGone(Visit visit) const {
    for (std::size_t i = 0; i < held_.size(); ++i) {
      const Known& known = trial()[i];
      const Held& held = held_[i];
      if (!held.is_taken) visit(known.a, known.b, held.p_W, held.f_W, held.t_W);
    }
  }
  /// The step is repeated with the forces of `points`, which ended at `after`.
  void learn(const std::vector<ContactPoint>& points, const States& after, double h) noexcept;
  /// The step is repeated with another length.
  void startAgain() noexcept { tries_learned_ = false; }
  /// The step is done: its points are known now.
  /// A step shorter than `least` [s] tells nothing new of their forces.
  void keep(const std::vector<ContactPoint>& points, const States& after, double h,
            double least) noexcept;

 private:
  /// Force of a point in a step.
  struct Force {
    PlainVec f_W;    ///< mean over the step [N]
    PlainVec t_W;    ///< against rolling and spinning [N m]
    PlainVec n_W;    ///< normal at its end
    double h = 0.0;  ///< length of the step [s]
    int age = 0;     ///< steps in which it had one; 0: not yet
  };
  struct Known {
    BodyIndex a = 0, b = kStanding;
    const void* surface = nullptr;  ///< RigidContact
    RigidRow::Mode mode = RigidRow::Mode::kUnknown;
    bool is_learned = false;            ///< `f_learned_W` is the force of the step itself
    double base = 0.0;                  ///< time over which `slope_W` was measured [s]
    PlainVec p_W, n_W;                  ///< at the start of the coming step
    PlainVec v_W, turn_W;               ///< velocity of the point, turning rate of the normal
    PlainVec slide_W;                   ///< velocity at which it slides [m/s]
    PlainVec slope_W;                   ///< rate of change of the force [N/s]
    PlainVec f_learned_W, t_learned_W;  ///< [N, N m]
    Force last;
  };
  /// A known point is held so, at the middle of the step.
  struct Held {
    PlainVec f_W, t_W, p_W, n_W;
    bool is_taken = false;  ///< the point is there at the end of the step
  };

  using PointIterator = std::vector<ContactPoint>::iterator;
  /// Places of known points, without `last`.
  struct Range {
    std::size_t first = 0, last = 0;
  };

  /// The points of the present try: in the order of held_.
  [[nodiscard]] const std::vector<Known>& trial() const noexcept {
    return tries_learned_ ? learned_ : known_;
  }
  [[nodiscard]] std::vector<Known>& trial() noexcept { return tries_learned_ ? learned_ : known_; }
  [[nodiscard]] const Known& knownOf(const ContactPoint& point) const noexcept {
    return trial()[static_cast<std::size_t>(point.known)];
  }
  [[nodiscard]] double expectedForceOf(const ContactPoint& point) const noexcept;
  static void limit(Force& force, double most) noexcept;
  void describe(const ContactPoint& point, const States& after, double h,
                Known& known) const noexcept;
  [[nodiscard]] Range findPair(const RigidContact& contact) const noexcept;
  [[nodiscard]] double squareOff(const ContactPoint& point, std::size_t place,
                                 double h) const noexcept;
  [[nodiscard]] bool isFree(std::size_t place, const ContactPoint& point) const noexcept;
  [[nodiscard]] bool matchExpected(ContactPoint& point, double h) noexcept;
  void matchNearest(PointIterator first, PointIterator last, double h) noexcept;
  void take(ContactPoint& point, std::size_t place, double h) noexcept;

  std::vector<Known> known_;    ///< after the last step
  std::vector<Known> learned_;  ///< in a try of the next one itself
  std::vector<Known> next_known_;
  std::vector<Known> marked_;  ///< before the present advance
  bool tries_learned_ = false;
  std::vector<Held> held_;  ///< in the present try
  std::size_t next_ = 0;    ///< place after the last match
};

}  // namespace tandem
