#pragma once

#include <vector>

#include "island/island_model.h"
#include "island/oscillator_map.h"
#include "island/rigid_step.h"
#include "island/sleepers.h"
#include "island/smooth_motion.h"
#include "island/touch.h"

namespace tandem {

/// Motion of a free island in three dimensions.
///
///   alone with its couplers  -> exact map of translation (OscillatorMap); of turning, too, while
///   no
///                               torque acts
///   in reach of a contact    -> SmoothMotion, make and break located in the step
///   near something rigid     -> the same in inner steps, each corrected by RigidStep
///
/// A body counts as alone while nothing can reach it within the time asked for; if the end shows
/// that something did, the time is done again as a contact.
class SpatialMotion {
 public:
  /// Allocates.
  explicit SpatialMotion(const IslandModel& model);

  /// A slot was filled or cleared. Real-time safe.
  void refill(const IslandModel& model, BodyIndex slot) noexcept;

  /// The gains of a body's couplers have changed, or its damping. Real-time safe.
  void refit(const IslandModel& model, BodyIndex b, bool is_damping) noexcept;

  /// Returns whether all seems at rest now. Real-time safe.
  bool advance(IslandModel& model, double dt, IslandCounters& counters) noexcept;

  /// Puts away what is known of contacts and rest, for an advance that others have no part in.
  void setAside() noexcept;
  /// Takes it out again; what the slots have learnt meanwhile is forgotten.
  void takeBack(const IslandModel& model, const std::vector<BodyIndex>& slots) noexcept;

  /// True if something rigid held the body in the last advance, and it was moved there.
  [[nodiscard]] bool wasHeld(BodyIndex b) const noexcept { return rigid_near_[b] && !resting_[b]; }
  /// True if it rests on something rigid and was not moved.
  [[nodiscard]] bool isResting(BodyIndex b) const noexcept { return resting_[b]; }
  /// True if it stood still in the last advance with nothing rigid near that could move it.
  [[nodiscard]] bool isAtRest(BodyIndex b) const noexcept {
    return at_rest_[b] && (resting_[b] || !rigid_near_[b]);
  }
  /// Leaves out a body that is at rest, if no sphere is near.
  void letSleep(IslandModel& model, BodyIndex b) noexcept;

 private:
  /// How a body moves while it is alone.
  struct Alone {
    double stiffness = 0.0, damping = 0.0;  ///< of all its couplers, per mass
    OscillatorMap map;                      ///< over a haptic period
    bool is_tied_to_turn = false;           ///< some coupler turns it
  };

  void prepareAlone(const IslandModel& model, BodyIndex b) noexcept;
  void findLoners(IslandModel& model, double dt, IslandCounters& counters) noexcept;
  void findTouches(const IslandModel& model, IslandCounters& counters) noexcept;
  void addTouch(const Touch& touch) noexcept;
  [[nodiscard]] bool needsTurning(const IslandModel& model, BodyIndex b) const noexcept;
  void advanceAlone(const IslandModel& model, double dt) noexcept;
  void turnAlone(const ModelBody& body, double dt, RigidState& state) const noexcept;
  [[nodiscard]] bool wasAlone(IslandModel& model, double dt) noexcept;
  void advanceTogether(const IslandModel& model, double dt, IslandCounters& counters) noexcept;
  void lookAround(IslandModel& model) noexcept;
  void advanceWithRigid(const IslandModel& model, double h, IslandCounters& counters) noexcept;
  void letRest(const IslandModel& model, double dt) noexcept;

  std::vector<Alone> alone_motion_;  ///< per body
  std::vector<char> alone_;          ///< per body: translation by its exact map
  std::vector<char> turns_;          ///< per body: alone, and turned exactly
  std::vector<char> together_;       ///< per body: integrated (also the turning of one alone)
  std::vector<char> rigid_near_;     ///< per body
  std::vector<char> resting_;        ///< per body: held by something rigid, and frozen
  std::vector<char> at_rest_;        ///< per body: it seemed to be after the last advance
  std::vector<double> still_;        ///< per body: for how long it has stood still [s]
  std::vector<char> awake_;          ///< per body: rigid and not resting
  std::vector<double> reach_;        ///< per body, for the ContactFinder [m]
  RigidStep rigid_step_, rigid_step_aside_;
  std::vector<char> resting_aside_;
  std::vector<double> still_aside_;
  std::vector<double> allowance_;  ///< per body: no part of it should go further this time [m]
  std::vector<Touch> touches_;     ///< in reach
  SmoothMotion smooth_;
  Sleepers sleepers_;

  // Working memory of a step, by body.
  States states_, before_rigid_;
  std::vector<Vec3> f_W_;
};

}  // namespace tandem
