#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/turn.h"
#include "island/grip_law.h"
#include "island/island.h"
#include "island/island_catch_up.h"
#include "island/island_model.h"
#include "island/jumps.h"
#include "island/rest.h"
#include "island/slot_motion.h"
#include "island/spatial_motion.h"
#include "island/touch.h"

/// \file
/// The state behind an Island, shared by its set-up and its work in the tick. Only these two files
/// include it.
namespace tandem {

struct Island::Impl {
  IslandModel model;
  IslandCounters counters;
  std::uint64_t revision = 0;
  std::optional<SlotMotion> slot;
  std::optional<SpatialMotion> spatial;
  std::vector<Wrench> wrenches;
  States states;
  std::vector<RigidContact> touching;  ///< working memory of shift()
  IslandCatchUp catch_up;
  bool prepared = false;
  bool asleep = false;
  std::uint64_t obstacles_hash = 0;  ///< hash when the island fell asleep

  /// Gives contacts with what has jumped their allowances.
  void letJumpsIn() noexcept {
    tandem::letJumpsIn(model, states);
    if (slot) slot->recall(model);
  }
  void endJumps(double dt) noexcept {
    tandem::endJumps(model, dt, states);
    if (slot) slot->recall(model);
  }

  /// Reads the present states of all bodies into `states`.
  void readStates() noexcept {
    for (std::size_t b = 0; b < states.size(); ++b) states[b] = model.bodies[b].state;
  }

  void disturb(BodyIndex body) noexcept {
    asleep = false;
    model.bodies[body].disturbed = true;
    model.wake(body);
  }

  /// Wakes a body and its contact partners after its gains, damping or contacts changed.
  void refit(BodyIndex body, bool is_damping) noexcept {
    disturb(body);
    if (slot) slot->refit(model);
    if (spatial) spatial->refit(model, body, is_damping);
    for (const IslandContact& contact : model.contacts) {
      if (contact.sphere == body) disturb(contact.other);
      if (contact.other == body) disturb(contact.sphere);
    }
  }

  void noteJumps() noexcept { model.has_jumps = model.remembers_touches; }
  /// A new shape in an old one's place has other faces.
  void forgetFacesOfNew() noexcept {
    for (std::size_t place = 0; place < model.obstacles->size(); ++place) {
      const Obstacle& obstacle = (*model.obstacles)[place];
      if (obstacle.change == ObstacleChange::kNew)
        model.faces.forgetObstacle(keyOf(obstacle, place));
    }
  }
  [[nodiscard]] bool isLettingIn() const noexcept {
    return model.has_jumps || !model.memory.isEmpty();
  }

  /// Falls asleep if the forces allow it.
  void tryToSleep() noexcept {
    if (!model.memory.isEmpty()) return;
    computeContactWrenches();
    for (const BodyIndex b : model.present) {
      if (spatial->wasHeld(b)) return;
      if (!spatial->isResting(b) && !isSettled(model, b, addUp(b, wrenches[b]))) return;
    }
    asleep = true;
    obstacles_hash = computeHash(model.obstacles);
  }

  /// Puts single bodies at rest to sleep if nothing is near.
  void letSomeSleep() noexcept {
    for (const BodyIndex b : model.present) {
      const ModelBody& body = model.bodies[b];
      if (!body.isDynamic() || body.is_slot || body.settings.feels_obstacles) continue;
      if (model.isGripped(b)) continue;
      if (!spatial->isAtRest(b)) continue;
      // Contact forces are left out: letSleep() refuses if a contact is near.
      if (spatial->isResting(b) || isSettled(model, b, addUp(b, {}))) spatial->letSleep(model, b);
    }
  }

  /// Sum of all forces on a body; the caller passes those of contacts.
  [[nodiscard]] Wrench addUp(BodyIndex body, Wrench sum) const noexcept {
    const ModelBody& b = model.bodies[body];
    sum.f_W += b.f_external_W - b.damping() * b.state.v_W;
    sum.t_W += b.t_external_W + computeAngularDamping(b.settings, b.state);
    for (const ModelCoupler& coupler : model.couplers) {
      if (coupler.follower != body) continue;
      const Wrench pull = computeCouplerWrench(coupler, b.state);
      sum.f_W += pull.f_W;
      sum.t_W += pull.t_W;
    }
    return sum;
  }

  /// Contact wrenches of a free island at this instant, written to `wrenches`: all, or those of one
  /// body.
  void computeContactWrenches(BodyIndex only = kStanding) noexcept {
    if (model.has_jumps) letJumpsIn();
    if (!model.is_listed) model.listPresent();
    for (const BodyIndex b : model.present) {
      states[b] = model.bodies[b].state;
      wrenches[b] = {};
    }
    const auto addAll = [&](Touch touch) {
      if (!couldMeet(model, touch, states, 0.0)) return;
      recall(model, touch, 0.5 * model.settings.haptic_period);
      const auto add = [&](const Touch& one) {
        const TouchState state = computeTouchState(model, one, states);
        const double push = computePush(one, state);
        if (push > 0.0) addPush(model, one, state, push, states, wrenches);
      };
      if (isWholeMesh(model, touch))
        forEachPiece(model, touch, states, 0.0, [&](const Touch& piece, double) { add(piece); });
      else
        add(touch);
    };
    forEachTouch(
        model, addAll,
        [&](const Touch& whole) { return couldMeetAnyPart(model, whole, states, 0.0); }, only);
    for (const int g : model.present_grips) addPull(model.grips[g]);
  }

  /// Pull of a grip at this instant.
  [[nodiscard]] GripPull computePull(const ModelGrip& grip) const noexcept {
    const RigidState& hand = model.bodies[grip.hand].state;
    const RigidState& body = model.bodies[grip.hold.body].state;
    const Vec3 arm_W = body.q_WB * grip.hold.p_FG;
    PlainVec turn;
    if (model.bodies[grip.hold.body].rotates())
      turn = computeTurn(body.q_WB.coeffs().data(), grip.hold.q_WF.coeffs().data());
    const GripLaw::Pull pull = GripLaw(grip.hold).compute(
        PlainVec(Vec3(hand.p_W - body.p_W - arm_W)),
        PlainVec(Vec3(hand.v_W - body.v_W - body.w_W.cross(arm_W))), turn, PlainVec(body.w_W));
    return {pull.f.toVec3(), pull.t.toVec3(), pull.load.toVec3(), pull.is_limited};
  }

  void addPull(const ModelGrip& grip) noexcept {
    const GripPull pull = computePull(grip);
    const BodyIndex b = grip.hold.body;
    wrenches[grip.hand].f_W -= pull.f_W;
    const Vec3 f_W = pull.f_W + pull.load_W;
    wrenches[b].f_W += f_W;
    if (!model.bodies[b].rotates()) return;
    const Vec3 arm_W = model.bodies[b].state.q_WB * grip.hold.p_FG;
    wrenches[b].t_W += arm_W.cross(f_W) + pull.t_W;
  }

  [[nodiscard]] Wrench contactWrench(BodyIndex body) noexcept {
    if (slot && model.has_jumps) letJumpsIn();
    if (slot) return {*model.settings.guide * slot->computeContactForce(model, body), Vec3::Zero()};
    wrenches[body] = {};
    computeContactWrenches(body);
    return wrenches[body];
  }
};

}  // namespace tandem
