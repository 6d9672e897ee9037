#pragma once

#include <vector>

#include "island/contact_tally.h"
#include "island/island_model.h"
#include "island/oscillator_map.h"
#include "island/rigid_step.h"
#include "island/sleepers.h"
#include "island/smooth_motion.h"
#include "island/touch.h"

namespace tandem {

// clang-format off
/// Motion of a free island in three dimensions.
///
///   alone with its couplers  -> exact map of translation (OscillatorMap), and of rotation while no
///                               torque acts
///   in reach of a contact    -> SmoothMotion, which locates contacts made and broken in the step
///   near something rigid,    -> SmoothMotion in inner steps, each corrected by RigidStep
///   or in a joint
///
/// A body counts as alone while nothing can reach it within the step. If the end shows that
/// something did, the step is repeated with contact.
// clang-format on
class SpatialMotion {
 public:
  /// Allocates.
  explicit SpatialMotion(const IslandModel& model);

  /// Updates for a slot that was filled or cleared. Real-time safe.
  void refill(const IslandModel& model, BodyIndex slot) noexcept;

  /// Updates for changed coupler gains of a body, or a changed damping. Real-time safe.
  void refit(const IslandModel& model, BodyIndex b, bool is_damping) noexcept;

  /// A hand took hold of a body, or let go. Real-time safe.
  void regrip(const IslandModel& model) noexcept { smooth_.chooseLimits(model); }

  /// Moves the bodies by `dt` [s]. Returns true if all seem at rest now. Real-time safe.
  bool advance(IslandModel& model, double dt, IslandCounters& counters) noexcept;

  /// Joints answer what something outside did to velocities since the last advance: `states`, of
  /// all bodies, get theirs. Real-time safe.
  void answerJoints(const IslandModel& model, States& states) noexcept;

  /// The model's positions were shifted. Real-time safe.
  void shiftOrigin(const Vec3& offset_W) noexcept {
    rigid_step_.shiftOrigin(offset_W);
    tally_.shiftOrigin(offset_W);
  }
  /// Stores the data on contacts and rest away, for an advance of some bodies only.
  void setAside() noexcept;
  /// Restores that data, and forgets that of the slots.
  void takeBack(const IslandModel& model, const std::vector<BodyIndex>& slots) noexcept;

  /// True if a rigid contact held the body in the last advance and it was moved.
  [[nodiscard]] bool wasHeld(BodyIndex b) const noexcept { return rigid_near_[b] && !resting_[b]; }
  /// True if it rests on a rigid contact and was not moved.
  [[nodiscard]] bool isResting(BodyIndex b) const noexcept { return resting_[b]; }
  /// True if it stood still in the last advance and nothing rigid near could move it.
  [[nodiscard]] bool isAtRest(BodyIndex b) const noexcept {
    return at_rest_[b] && !joined_[b] && (resting_[b] || !rigid_near_[b]);
  }
  /// Points of rigid contact since the last host step.
  [[nodiscard]] ContactTally& tally() noexcept { return tally_; }
  /// Puts a body at rest to sleep, if no sphere is near.
  void letSleep(IslandModel& model, BodyIndex b) noexcept;

 private:
  /// Exact motion of a body while it is alone.
  struct Alone {
    double stiffness = 0.0, damping = 0.0;  ///< sum over its couplers, per mass of its freest axis
    OscillatorMap map;                      ///< over a haptic period
    bool is_tied_to_turn = false;           ///< some coupler rotates it
  };

  void prepareAlone(const IslandModel& model, BodyIndex b) noexcept;
  void findLoners(IslandModel& model, double dt, IslandCounters& counters) noexcept;
  void findTouches(IslandModel& model, IslandCounters& counters) noexcept;
  void addTouch(const IslandModel& model, const Touch& touch) noexcept;
  [[nodiscard]] bool needsTurning(const IslandModel& model, BodyIndex b) const noexcept;
  void advanceAlone(const IslandModel& model, double dt) noexcept;
  static void goAloneByFactors(const ModelBody& body, const Alone& alone, const Vec3& f_W,
                               double dt, RigidState& state) noexcept;
  void turnAlone(const ModelBody& body, double dt, RigidState& state) const noexcept;
  /// True if bodies that advanced alone have met, or a sleeper near them was woken.
  [[nodiscard]] bool mustRepeat(IslandModel& model, double dt) noexcept;
  void advanceTogether(const IslandModel& model, double dt, IslandCounters& counters) noexcept;
  void findJoined(const IslandModel& model) noexcept;
  void lookAround(IslandModel& model) noexcept;
  void restTogether(const IslandModel& model, bool begins_anew) noexcept;
  void advanceWithRigid(const IslandModel& model, double h, IslandCounters& counters) noexcept;
  void letRest(const IslandModel& model, double dt) noexcept;

  std::vector<Alone> alone_motion_;  ///< per body
  std::vector<char> alone_;          ///< per body: exact map of translation
  std::vector<char> turns_;          ///< per body: alone, and rotated exactly
  std::vector<char> together_;       ///< per body: integrated (also the rotation of one alone)
  std::vector<char> rigid_near_;     ///< per body: a rigid contact is near
  std::vector<char> joined_;         ///< per body: a joint acts on it
  bool were_joined_pushed_ = false;  ///< something outside changed a body in a joint
  std::vector<char> resting_;        ///< per body: held by a rigid contact, and frozen
  std::vector<char> at_rest_;        ///< per body: seemed at rest after the last advance
  std::vector<double> still_;        ///< per body: time it has stood still [s]
  std::vector<char> moves_;          ///< per body: forces, or something outside, may move it
  std::vector<char> awake_;          ///< per body: rigid and not resting
  std::vector<double> reach_;        ///< per body: reach for the ContactFinder [m]
  JointForces joints_;
  JointMemory joint_memory_aside_;
  RigidStep rigid_step_, rigid_step_aside_;
  ContactTally tally_;
  bool is_aside_ = false;  ///< between setAside() and takeBack()
  std::vector<char> resting_aside_;
  std::vector<double> still_aside_;
  std::vector<double> allowance_;  ///< per body: expected longest motion of a part [m]
  std::vector<Touch> touches_;     ///< touches in reach
  SmoothMotion smooth_;
  Sleepers sleepers_;

  // Working memory of a step, by body.
  States states_, before_rigid_;
  std::vector<Vec3> f_W_;
};

}  // namespace tandem
