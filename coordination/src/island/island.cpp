#include "island/island.h"

#include <algorithm>
#include <cmath>

#include "bad_value.h"
#include "island/island_catch_up.h"
#include "island/island_model.h"
#include "island/jumps.h"
#include "island/rest.h"
#include "island/slot_motion.h"
#include "island/spatial_motion.h"
#include "island/touch.h"
#include "tandem_assert.h"

namespace tandem {
namespace {

/// Most contacts that were let in and still push with less than their overlap.
constexpr std::size_t kMostRemembered = 64;

void checkNotNegative(const char* name, double value) {
  if (!(value >= 0.0) || !std::isfinite(value)) throwBadValue(name, value, "a finite number >= 0");
}

void checkPositive(const char* name, double value) {
  if (!(value > 0.0) || !std::isfinite(value)) throwBadValue(name, value, "a finite number > 0");
}

void checkGains(const char* name, const CouplerGains& gains) {
  checkNotNegative((std::string(name) + " stiffness").c_str(), gains.stiffness);
  checkNotNegative((std::string(name) + " damping").c_str(), gains.damping);
}

void checkBody(const IslandBody& body, bool is_guided) {
  checkShape(body.shape);
  checkNotNegative("body damping", body.damping);
  checkNotNegative("body angular damping", body.angular_damping);
  if (!isFinite(body.start)) throw std::invalid_argument("a body's start state must be finite");
  if (body.feels_obstacles && !std::holds_alternative<Sphere>(body.shape))
    throw std::invalid_argument("only a sphere feels obstacles; make other shapes is_rigid");
  if (std::holds_alternative<Mesh>(body.shape))
    throw std::invalid_argument("a mesh cannot be a body of an island; make it an obstacle");
  if (body.motion != Motion::kDynamic) return;
  checkPositive("body mass", body.mass);
  if (is_guided) return;
  for (int axis = 0; axis < 3; ++axis) checkNotNegative("body inertia", body.inertia_B[axis]);
}

inline bool isSame(const RigidState& a, const RigidState& b) noexcept {
  return a.p_W == b.p_W && a.v_W == b.v_W && a.w_W == b.w_W && a.q_WB.coeffs() == b.q_WB.coeffs();
}

}  // namespace

struct Island::Impl {
  IslandModel model;
  IslandCounters counters;
  std::uint64_t revision = 0;
  std::optional<SlotMotion> slot;
  std::optional<SpatialMotion> spatial;
  std::vector<Wrench> wrenches;
  States states;
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

  void noteJumps() noexcept { model.has_jumps = model.gentle_starts; }
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

  /// Contact wrenches of a free island at this instant, written to `wrenches`.
  void computeContactWrenches() noexcept {
    if (model.has_jumps) letJumpsIn();
    if (!model.is_listed) model.listPresent();
    for (const BodyIndex b : model.present) {
      states[b] = model.bodies[b].state;
      wrenches[b] = {};
    }
    forEachTouch(model, [&](Touch touch) {
      if (!couldMeet(model, touch, states, 0.0)) return;
      recall(model, touch, 0.5 * model.settings.haptic_period);
      const auto add = [&](const Touch& one) {
        const TouchState state = computeTouchState(model, one, states);
        const double push = computePush(one, state);
        if (push > 0.0) addPush(model, one, state, push, states, wrenches);
      };
      if (isWholeMesh(touch))
        forEachPiece(model, touch, states, 0.0, [&](const Touch& piece, double) { add(piece); });
      else
        add(touch);
    });
  }

  [[nodiscard]] Wrench contactWrench(BodyIndex body) noexcept {
    if (slot && model.has_jumps) letJumpsIn();
    if (slot) return {*model.settings.guide * slot->computeContactForce(model, body), Vec3::Zero()};
    wrenches[body] = {};
    computeContactWrenches();
    return wrenches[body];
  }
};

Island::Island(const IslandSettings& settings) : impl_(std::make_unique<Impl>()) {
  checkPositive("haptic period", settings.haptic_period);
  checkPositive("inner step", settings.inner_step);
  checkPositive("tolerance", settings.tolerance);
  checkGains("obstacle contact", settings.obstacle_contact);
  if (settings.guide && !(std::abs(settings.guide->norm() - 1.0) < 1e-9))
    throwBadValue("norm of the guide", settings.guide->norm(), "a unit vector");
  impl_->model.settings = settings;
}

Island::~Island() = default;
Island::Island(Island&&) noexcept = default;
Island& Island::operator=(Island&&) noexcept = default;

BodyIndex Island::addBody(const IslandBody& body) {
  const bool is_guided = impl_->model.settings.guide.has_value();
  checkBody(body, is_guided);
  impl_->model.bodies.push_back(ModelBody::make(body, is_guided));
  impl_->prepared = false;
  return bodyCount() - 1;
}

BodyIndex Island::addSlot() {
  if (impl_->model.settings.guide)
    throw std::invalid_argument("a guided island has no slots; leave the guide off");
  ModelBody slot;
  slot.is_slot = true;
  slot.is_active = false;
  impl_->model.bodies.push_back(slot);
  impl_->model.slots.push_back(bodyCount() - 1);
  impl_->prepared = false;
  return bodyCount() - 1;
}

CouplerIndex Island::addCoupler(BodyIndex follower, const CouplerSettings& settings) {
  TANDEM_ASSERT(follower >= 0 && follower < bodyCount());
  checkGains("coupler", settings.linear);
  checkGains("angular coupler", settings.angular);
  impl_->model.couplers.push_back(
      {follower, settings, impl_->model.bodies[follower].settings.start});
  impl_->prepared = false;
  return static_cast<CouplerIndex>(impl_->model.couplers.size()) - 1;
}

void Island::addContact(BodyIndex sphere, BodyIndex other, const CouplerGains& gains) {
  TANDEM_ASSERT(sphere >= 0 && sphere < bodyCount() && other >= 0 && other < bodyCount() &&
                sphere != other);
  if (!std::holds_alternative<Sphere>(impl_->model.bodies[sphere].settings.shape))
    throw std::invalid_argument("smooth contact is between a sphere and another body");
  checkGains("contact", gains);
  impl_->model.contacts.push_back({sphere, other, gains});
  impl_->prepared = false;
}

void Island::setGentleStarts(bool are_gentle) noexcept {
  impl_->model.gentle_starts = are_gentle;
  if (are_gentle) return;
  impl_->model.has_jumps = false;
  impl_->model.memory.clear();
}

void Island::setContactFinder(ContactFinder* finder) {
  impl_->model.finder = finder;
  wake();
}

void Island::prepare() {
  Impl& impl = *impl_;
  impl.counters = {};
  impl.asleep = false;
  impl.slot.reset();
  impl.spatial.reset();
  if (impl.model.settings.guide) {
    impl.slot.emplace(impl.model);
  } else {
    impl.spatial.emplace(impl.model);
  }
  impl.wrenches.resize(impl.model.bodies.size());
  impl.states.resize(impl.model.bodies.size());
  for (ModelBody& body : impl.model.bodies) body.is_asleep = false;
  impl.model.memory.makeRoom(kMostRemembered);
  impl.noteJumps();
  impl.model.reserveLists();
  impl.model.listPresent();
  impl.catch_up.prepare(impl.model);
  impl.prepared = true;
}

void Island::setState(BodyIndex body, const RigidState& state) noexcept {
  ModelBody& b = impl_->model.bodies[body];
  if (isSame(b.state, state)) return;
  if (mayJump(b, state) && impl_->prepared) [[unlikely]]
    notePlacing(impl_->model, body, state, impl_->states);
  b.state = state;
  impl_->disturb(body);
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
  const Vec3 t_felt_W = b.rotates() ? t_W : Vec3::Zero();
  if (b.f_external_W == f_W && b.t_external_W == t_felt_W) return;
  b.f_external_W = f_W;
  b.t_external_W = t_felt_W;
  impl_->disturb(body);
}

void Island::applyImpulse(BodyIndex body, const Vec3& impulse_W, const Vec3& angular_W) noexcept {
  if (impulse_W == Vec3::Zero() && angular_W == Vec3::Zero()) return;
  if (impl_->model.bodies[body].is_ghost) return;
  impl_->disturb(body);
  ModelBody& b = impl_->model.bodies[body];
  b.state.v_W += b.inverse_mass * impulse_W;
  if (!b.rotates()) return;
  const Quat& q = b.state.q_WB;
  b.state.w_W += q * b.inverse_inertia_B.cwiseProduct(q.conjugate() * angular_W);
}

void Island::setCouplerShare(CouplerIndex coupler, double share) noexcept {
  TANDEM_ASSERT(impl_->prepared && share >= 0.0 && share <= 1.0);
  ModelCoupler& c = impl_->model.couplers[coupler];
  if (c.share == share) return;
  c.share = share;
  c.now = {computeShare(c.settings.linear, share), computeShare(c.settings.angular, share)};
  impl_->refit(c.follower, false);
}

void Island::setContactShare(BodyIndex body, double share) noexcept {
  TANDEM_ASSERT(impl_->prepared && share >= 0.0 && share <= 1.0);
  ModelBody& b = impl_->model.bodies[body];
  if (b.contact_share == share) return;
  b.contact_share = share;
  impl_->refit(body, false);
}

void Island::setExtraDamping(BodyIndex body, double damping) noexcept {
  TANDEM_ASSERT(impl_->prepared && damping >= 0.0);
  ModelBody& b = impl_->model.bodies[body];
  if (b.extra_damping == damping) return;
  b.extra_damping = damping;
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
  TANDEM_ASSERT(impl_->prepared && impl_->model.bodies[slot].is_slot);
  TANDEM_ASSERT((body.motion != Motion::kDynamic || body.mass > 0.0) && isFinite(body.start));
  ModelBody& filled = impl_->model.bodies[slot];
  if (filled.is_active && mayJump(filled, body.start))
    notePlacing(impl_->model, slot, body.start, impl_->states);
  const bool has_jumped = !filled.is_active || filled.has_jumped;
  filled = ModelBody::make(body, false);
  filled.settings.feels_obstacles = false;
  filled.is_slot = true;
  filled.has_jumped = has_jumped;
  if (has_jumped) impl_->noteJumps();
  impl_->model.is_listed = false;
  impl_->disturb(slot);
  impl_->spatial->refill(impl_->model, slot);
}

void Island::clear(BodyIndex slot) noexcept {
  TANDEM_ASSERT(impl_->model.bodies[slot].is_slot);
  ModelBody cleared;
  cleared.is_slot = true;
  cleared.is_active = false;
  impl_->model.bodies[slot] = cleared;
  impl_->model.memory.forget(slot);
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

const CouplerSettings& Island::couplerSettings(CouplerIndex coupler) const noexcept {
  return impl_->model.couplers[coupler].settings;
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
  for (std::size_t b = 0; b < impl.states.size(); ++b) impl.states[b] = impl.model.bodies[b].state;
  return tandem::computeOverlap(impl.model, impl.states, body);
}

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
