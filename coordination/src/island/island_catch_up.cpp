#include "island/island_catch_up.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/turn.h"
#include "island/jumps.h"

namespace tandem {
namespace {

/// Constant velocities that lead from one pose to another in `duration` [s].
Aside computeSteady(const RigidState& from, const RigidState& to, double duration) noexcept {
  const Vec3 turn_W = computeTurn(from.q_WB.coeffs().data(), to.q_WB.coeffs().data()).toVec3();
  return {Vec3::Zero(), (to.p_W - from.p_W) / duration, turn_W / duration};
}

}  // namespace

void IslandCatchUp::prepare(const IslandModel& model) {
  bodies_ = model.bodies;
  states_.resize(bodies_.size());
  slots_.reserve(model.slots.size());
}

void IslandCatchUp::run(IslandModel& model, SpatialMotion& motion, IslandCounters& counters,
                        const std::vector<BodyIndex>& slots, const std::vector<RigidState>& from,
                        const std::vector<RigidState>& to, double duration,
                        std::vector<Aside>& asides) noexcept {
  const auto count = static_cast<BodyIndex>(model.bodies.size());
  const auto forEachOther = [&](auto visit) {
    for (BodyIndex b = 0; b < count; ++b)
      if (std::find(slots.begin(), slots.end(), b) == slots.end())
        visit(b, computeSteady(from[b], to[b], duration));
  };
  motion.setAside();
  setAside(model, slots);
  forEachOther([&](BodyIndex b, const Aside& steady) {
    sendAlong(model, b, steady, from[b], asides[b]);
    motion.refill(model, b);
  });
  if (model.has_jumps) letJumpsIn(model, states_);
  for (const BodyIndex slot : slots) model.bodies[slot].has_jumped = false;
  const double steps = std::ceil(duration / model.settings.haptic_period * (1.0 - 1e-9));
  for (double i = 0; i < steps; ++i) motion.advance(model, duration / steps, counters);
  forEachOther(
      [&](BodyIndex b, const Aside& steady) { bringBack(model, b, steady, to[b], asides[b]); });
  takeBack(model);
  motion.takeBack(model, slots);
}

/// Removes couplers, grips and smooth contacts: their effect on the other bodies is in the known
/// path.
void IslandCatchUp::setAside(IslandModel& model, const std::vector<BodyIndex>& slots) noexcept {
  slots_.assign(slots.begin(), slots.end());
  couplers_.clear();
  contacts_.clear();
  grips_.clear();
  swapPast(model);
  model.joins_slots_only = true;
  obstacles_ = std::exchange(model.obstacles, nullptr);
}

void IslandCatchUp::takeBack(IslandModel& model) noexcept {
  swapPast(model);
  model.joins_slots_only = false;
  model.obstacles = obstacles_;
}

void IslandCatchUp::swapPast(IslandModel& model) noexcept {
  model.couplers.swap(couplers_);
  model.contacts.swap(contacts_);
  model.grips.swap(grips_);
  model.slots.swap(slots_);
  std::swap(model.faces, faces_);
  model.is_listed = false;
}

/// Another body takes part with its mass and steady velocity, but without its own forces.
void IslandCatchUp::sendAlong(IslandModel& model, BodyIndex b, const Aside& steady,
                              const RigidState& from, const Aside& aside) noexcept {
  ModelBody& body = model.bodies[b];
  bodies_[b] = body;
  body.has_jumped = false;
  body.settings.damping = body.settings.angular_damping = body.extra_damping = 0.0;
  body.f_external_W.setZero();
  body.t_external_W.setZero();
  // Equal moments of inertia keep its rotation steady.
  body.settings.inertia_B.setConstant(body.settings.inertia_B.mean());
  body.inverse_inertia_B.setConstant(body.inverse_inertia_B.mean());
  body.state = {from.p_W + aside.offset_W, from.q_WB, steady.v_W + aside.v_W,
                steady.w_W + aside.w_W};
}

void IslandCatchUp::bringBack(IslandModel& model, BodyIndex b, const Aside& steady,
                              const RigidState& to, Aside& aside) noexcept {
  ModelBody& body = model.bodies[b];
  if (body.isDynamic())
    aside = {body.state.p_W - to.p_W, body.state.v_W - steady.v_W, body.state.w_W - steady.w_W};
  body = bodies_[b];
}

}  // namespace tandem
