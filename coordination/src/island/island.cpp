#include "island/island.h"

#include <algorithm>

#include "island/island_impl.h"
#include "island/shift.h"
#include "same_state.h"
#include "tandem_assert.h"

namespace tandem {

void Island::setState(BodyIndex body, const RigidState& state) noexcept {
  ModelBody& b = impl_->model.bodies[body];
  if (isSame(b.state, state)) return;
  if (!b.is_active) {
    b.state = state;
    return;
  }
  if (mayJump(b, state) && impl_->prepared) [[unlikely]]
    notePlacing(impl_->model, body, state, impl_->states);
  b.state = state;
  impl_->disturb(body);
}

void Island::shift(BodyIndex body, const Vec3& offset_W, const Quat& rotation_W) noexcept {
  IslandModel& model = impl_->model;
  RigidState next = model.bodies[body].state;
  Vec3 allowed_W = offset_W;
  if (model.finder && impl_->prepared && model.bodies[body].is_active) {
    impl_->readStates();
    allowed_W =
        limitShift(*model.finder, body, offset_W, rotation_W, impl_->states, impl_->touching);
  }
  next.p_W += allowed_W;
  next.q_WB = (rotation_W * next.q_WB).normalized();
  setState(body, next);
}

void Island::noteArrival(BodyIndex body) noexcept {
  if (impl_->prepared) noteJump(impl_->model, body, impl_->states);
}

void Island::setTarget(CouplerIndex coupler, const RigidState& target) noexcept {
  ModelCoupler& c = impl_->model.couplers[coupler];
  if (isSame(c.target, target)) return;
  c.target = target;
  impl_->disturb(c.follower);
}

void Island::setExternalWrench(BodyIndex body, const Vec3& f_W, const Vec3& t_W) noexcept {
  ModelBody& b = impl_->model.bodies[body];
  const Vec3 f_felt_W = b.factors.feltForce(f_W);
  const Vec3 t_felt_W = b.rotates() ? b.factors.feltTorque(t_W) : Vec3::Zero();
  if (b.f_external_W == f_felt_W && b.t_external_W == t_felt_W) return;
  b.f_external_W = f_felt_W;
  b.t_external_W = t_felt_W;
  impl_->disturb(body);
}

void Island::applyImpulse(BodyIndex body, const Vec3& impulse_W, const Vec3& angular_W) noexcept {
  if (impulse_W == Vec3::Zero() && angular_W == Vec3::Zero()) return;
  if (impl_->model.bodies[body].is_ghost) return;
  impl_->disturb(body);
  ModelBody& b = impl_->model.bodies[body];
  b.state.v_W += b.inverse_mass / b.factors.linear * impulse_W;
  if (!b.rotates()) return;
  const Quat& q = b.state.q_WB;
  const Vec3 inverse_inertia_B = b.inverse_inertia_B / b.factors.angular;
  b.state.w_W += q * inverse_inertia_B.cwiseProduct(q.conjugate() * angular_W);
}

void Island::answerJoints() noexcept {
  IslandModel& model = impl_->model;
  if (!impl_->prepared || !model.joints) return;
  impl_->readStates();
  impl_->spatial->answerJoints(model, impl_->states);
  for (std::size_t b = 0; b < impl_->states.size(); ++b) {
    RigidState& state = model.bodies[b].state;
    if (isSame(state, impl_->states[b])) continue;
    state = impl_->states[b];
    impl_->disturb(static_cast<BodyIndex>(b));
  }
}

void Island::setCouplerShare(CouplerIndex coupler, double share) noexcept {
  TANDEM_ASSERT(impl_->prepared && share >= 0.0 && share <= 1.0);
  ModelCoupler& c = impl_->model.couplers[coupler];
  if (c.share == share) return;
  c.share = share;
  c.now = {computeShare(c.settings.linear, share), computeShare(c.settings.angular, share)};
  impl_->refit(c.follower, false);
}

void Island::setGrip(GripIndex grip, const IslandGrip* hold) noexcept {
  Impl& impl = *impl_;
  ModelGrip& g = impl.model.grips[grip];
  const bool was_on = g.is_on;
  if (!hold && !was_on) return;
  const BodyIndex before = g.hold.body;
  const bool is_same_body = hold && was_on && hold->body == before;
  if (was_on && !is_same_body) {
    // Depths of other contacts are kept; that of the two is new.
    noteJump(impl.model, g.hand, impl.states);
    impl.disturb(before);
  }
  impl.model.is_listed =
      impl.model.is_listed && is_same_body && (hold->share > 0.0) == (g.hold.share > 0.0);
  g.is_on = hold != nullptr;
  if (hold) {
    g.hold = *hold;
    impl.disturb(hold->body);
  }
  impl.model.noteTools(g.hand);
  impl.disturb(g.hand);
  if (!is_same_body) impl.spatial->regrip(impl.model);
}

void Island::setContactShare(BodyIndex body, double share) noexcept {
  TANDEM_ASSERT(impl_->prepared && share >= 0.0 && share <= 1.0);
  ModelBody& b = impl_->model.bodies[body];
  const double of_all = share * b.settings.contact_share;
  if (b.contact_share == of_all) return;
  b.contact_share = of_all;
  impl_->refit(body, false);
}

void Island::setExtraDamping(BodyIndex body, double damping) noexcept {
  TANDEM_ASSERT(impl_->prepared && damping >= 0.0);
  ModelBody& b = impl_->model.bodies[body];
  if (b.extra_damping == damping) return;
  b.extra_damping = damping;
  impl_->refit(body, true);
}

void Island::setMass(BodyIndex body, double mass, const Vec3& inertia_B, double damping) noexcept {
  ModelBody& b = impl_->model.bodies[body];
  TANDEM_ASSERT(impl_->prepared && mass > 0.0 && inertia_B.minCoeff() >= 0.0 && damping >= 0.0);
  if (b.settings.mass == mass && b.settings.inertia_B == inertia_B && b.settings.damping == damping)
    return;
  IslandBody changed = b.settings;
  changed.mass = mass;
  changed.inertia_B = inertia_B;
  changed.damping = damping;
  b.takeMass(changed, impl_->model.settings.guide.has_value());
  impl_->refit(body, true);
}

void Island::setGhost(BodyIndex body, bool is_ghost) noexcept {
  ModelBody& b = impl_->model.bodies[body];
  TANDEM_ASSERT(impl_->prepared && !b.is_slot && !b.settings.is_rigid &&
                b.settings.motion != Motion::kPrescribed);
  if (b.is_ghost == is_ghost) return;
  b.is_ghost = is_ghost;
  impl_->model.is_listed = false;
  impl_->refit(body, false);
}

void Island::fill(BodyIndex slot, const IslandBody& body) noexcept {
  TANDEM_ASSERT(impl_->prepared && impl_->spatial);
  TANDEM_ASSERT((body.motion != Motion::kDynamic || body.mass > 0.0) && isFinite(body.start));
  ModelBody& filled = impl_->model.bodies[slot];
  if (filled.is_active && mayJump(filled, body.start))
    notePlacing(impl_->model, slot, body.start, impl_->states);
  const bool has_jumped = !filled.is_active || filled.has_jumped;
  const bool is_slot = filled.is_slot;
  filled = ModelBody::make(body, false);
  filled.settings.feels_obstacles = false;
  filled.is_slot = is_slot;
  filled.has_jumped = has_jumped;
  if (has_jumped) impl_->noteJumps();
  impl_->model.is_listed = false;
  impl_->disturb(slot);
  impl_->spatial->refill(impl_->model, slot);
}

void Island::clear(BodyIndex slot) noexcept {
  TANDEM_ASSERT(impl_->spatial || !impl_->prepared);
  ModelBody& body = impl_->model.bodies[slot];
  body = ModelBody::makeEmpty(body.is_slot);
  impl_->model.memory.forget(slot);
  impl_->model.faces.forget(slot);
  wake();
  // After an added body, prepare() comes next and rebuilds everything.
  if (impl_->prepared) impl_->spatial->refill(impl_->model, slot);
}

void Island::setObstacles(const std::vector<Obstacle>& obstacles) noexcept {
  impl_->model.obstacles = &obstacles;
  const bool has_changed = std::any_of(
      obstacles.begin(), obstacles.end(),
      [](const Obstacle& obstacle) { return obstacle.change != ObstacleChange::kNone; });
  if (has_changed) {
    impl_->model.has_arrivals = true;
    impl_->noteJumps();
    impl_->forgetFacesOfNew();
  }
  // The same vector may have new contents.
  if (impl_->asleep && computeHash(&obstacles) != impl_->obstacles_hash) wake();
}

void Island::wake() noexcept {
  impl_->asleep = false;
  for (ModelBody& body : impl_->model.bodies) {
    body.disturbed = true;
    body.is_asleep = false;
  }
  impl_->model.is_listed = false;
}

void Island::shiftOrigin(const Vec3& offset_W) noexcept {
  Impl& impl = *impl_;
  wake();
  for (ModelBody& body : impl.model.bodies) {
    body.settings.start.p_W += offset_W;
    body.state.p_W += offset_W;
  }
  for (ModelCoupler& coupler : impl.model.couplers) coupler.target.p_W += offset_W;
  if (impl.slot) impl.slot->shiftOrigin(offset_W);
  if (impl.spatial) impl.spatial->shiftOrigin(offset_W);
}

void Island::cutContacts(double duration) noexcept {
  if (!impl_->spatial) return;
  impl_->spatial->tally().cut(duration, [&](BodyIndex body) { return isStill(body); });
}

const std::vector<ContactSum>& Island::takeContacts() noexcept {
  static const std::vector<ContactSum> none;
  return impl_->spatial ? impl_->spatial->tally().take() : none;
}

bool Island::isStill(BodyIndex body) const noexcept {
  return !isDynamic(body) || (impl_->spatial && impl_->spatial->isResting(body));
}

void Island::passTime(double dt) noexcept {
  if (impl_->isLettingIn()) impl_->endJumps(dt);
}

void Island::advance(double dt) noexcept {
  Impl& impl = *impl_;
  TANDEM_ASSERT(impl.prepared);
  TANDEM_ASSERT(dt > 0.0 && dt <= impl.model.settings.haptic_period * (1.0 + 1e-9));
  ++impl.counters.advances;
  if (impl.asleep) {
    ++impl.counters.asleep;
    return;
  }
  ++impl.revision;
  const bool is_letting_in = impl.isLettingIn();
  if (impl.model.has_jumps) impl.letJumpsIn();
  if (impl.slot) {
    impl.slot->advance(impl.model, dt);
  } else {
    if (impl.spatial->advance(impl.model, dt, impl.counters)) impl.tryToSleep();
    impl.counters.asleep_bodies += static_cast<std::uint64_t>(impl.model.asleep_count);
    if (!impl.asleep) impl.letSomeSleep();
  }
  if (is_letting_in) impl.endJumps(dt);
}

void Island::catchUp(const std::vector<BodyIndex>& slots, const std::vector<RigidState>& from,
                     const std::vector<RigidState>& to, double duration,
                     std::vector<Aside>& asides) noexcept {
  Impl& impl = *impl_;
  TANDEM_ASSERT(impl.prepared && impl.spatial && duration > 0.0);
  wake();
  impl.catch_up.run(impl.model, *impl.spatial, impl.counters, slots, from, to, duration, asides);
}

std::uint64_t Island::revision() const noexcept { return impl_->revision; }
bool Island::isAsleep() const noexcept { return impl_->asleep; }

const std::vector<BodyIndex>& Island::awakeBodies() const noexcept {
  if (!impl_->model.is_listed) impl_->model.listPresent();
  return impl_->model.present;
}

const IslandCounters& Island::counters() const noexcept { return impl_->counters; }

const RigidState& Island::state(BodyIndex body) const noexcept {
  return impl_->model.bodies[body].state;
}

const RigidState& Island::target(CouplerIndex coupler) const noexcept {
  return impl_->model.couplers[coupler].target;
}

int Island::bodyCount() const noexcept { return static_cast<int>(impl_->model.bodies.size()); }

bool Island::isSlot(BodyIndex body) const noexcept { return impl_->model.bodies[body].is_slot; }

const IslandBody& Island::body(BodyIndex body) const noexcept {
  return impl_->model.bodies[body].settings;
}

int Island::couplerCount() const noexcept { return static_cast<int>(impl_->model.couplers.size()); }

BodyIndex Island::follower(CouplerIndex coupler) const noexcept {
  return impl_->model.couplers[coupler].follower;
}

const CouplerSettings& Island::presentGains(CouplerIndex coupler) const noexcept {
  return impl_->model.couplers[coupler].now;
}

double Island::couplerShare(CouplerIndex coupler) const noexcept {
  return impl_->model.couplers[coupler].share;
}

double Island::contactShare(BodyIndex body) const noexcept {
  return impl_->model.bodies[body].contact_share;
}

double Island::extraDamping(BodyIndex body) const noexcept {
  return impl_->model.bodies[body].extra_damping;
}

bool Island::isGhost(BodyIndex body) const noexcept { return impl_->model.bodies[body].is_ghost; }

const std::vector<IslandContact>& Island::contacts() const noexcept {
  return impl_->model.contacts;
}

const std::vector<Obstacle>* Island::obstacles() const noexcept { return impl_->model.obstacles; }

bool Island::isDynamic(BodyIndex body) const noexcept {
  return impl_->model.bodies[body].isDynamic();
}

bool Island::isActive(BodyIndex body) const noexcept { return impl_->model.bodies[body].is_active; }

Vec3 Island::computeContactForce(BodyIndex body) const noexcept {
  TANDEM_ASSERT(impl_->prepared);
  return impl_->contactWrench(body).f_W;
}

const Vec3& Island::externalForce(BodyIndex body) const noexcept {
  return impl_->model.bodies[body].f_external_W;
}
const Vec3& Island::externalTorque(BodyIndex body) const noexcept {
  return impl_->model.bodies[body].t_external_W;
}

double Island::computeOverlap(BodyIndex body) const noexcept {
  TANDEM_ASSERT(impl_->prepared);
  Impl& impl = *impl_;
  if (impl.slot) return impl.slot->computeOverlap(impl.model, body);
  impl.readStates();
  return tandem::computeOverlap(impl.model, impl.states, body);
}

GripPull Island::computeGripPull(GripIndex grip) const noexcept {
  const ModelGrip& g = impl_->model.grips[grip];
  const auto& present = impl_->model.present_grips;
  if (!impl_->model.is_listed) impl_->model.listPresent();
  if (std::find(present.begin(), present.end(), grip) == present.end()) return {};
  return impl_->computePull(g);
}

double Island::deepestTouch() const noexcept { return impl_->model.faces.deepest(); }

Vec3 Island::computeCouplerForce(CouplerIndex coupler) const noexcept {
  const ModelCoupler& c = impl_->model.couplers[coupler];
  return computeCouplerWrench(c, impl_->model.bodies[c.follower].state).f_W;
}

void Island::computeWrench(BodyIndex body, Vec3& f_W, Vec3& t_W) const noexcept {
  TANDEM_ASSERT(impl_->prepared);
  const ModelBody& b = impl_->model.bodies[body];
  Wrench sum = impl_->addUp(body, impl_->contactWrench(body));
  if (const auto& guide = impl_->model.settings.guide)
    sum = {*guide * guide->dot(sum.f_W), Vec3::Zero()};
  f_W = sum.f_W;
  t_W = b.rotates() ? sum.t_W : Vec3::Zero();
}

}  // namespace tandem
