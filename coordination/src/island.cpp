#include "tandem/coordination/island.h"

#include <cmath>

#include "tandem/coordination/assert.h"

#include "bad_value.h"
#include "island_model.h"
#include "slot_motion.h"
#include "spatial_motion.h"

namespace tandem {
namespace {

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

}  // namespace

struct Island::Impl {
  IslandModel model;
  std::optional<SlotMotion> slot;
  std::optional<SpatialMotion> spatial;
  mutable std::vector<Wrench> wrenches;
  mutable States states;
  bool prepared = false;

  /// Contact wrenches of the free island at this instant, into `wrenches`.
  void computeContactWrenches() const noexcept {
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      states[b] = model.bodies[b].state;
      wrenches[b] = {};
    }
    forEachTouch(model, [&](const Touch& touch) {
      const TouchState state = computeTouchState(model, touch, states);
      const double push = computePush(touch, state);
      if (push > 0.0) addPush(model, touch, state, push, states, wrenches);
    });
  }

  [[nodiscard]] Wrench contactWrench(BodyIndex body) const noexcept {
    if (slot) return {*model.settings.guide * slot->computeContactForce(model, body), Vec3::Zero()};
    computeContactWrenches();
    return wrenches[body];
  }
};

Island::Island(const IslandSettings& settings) : impl_(std::make_unique<Impl>()) {
  checkPositive("haptic period", settings.haptic_period);
  checkPositive("inner step", settings.inner_step);
  checkGains("obstacle contact", settings.obstacle_contact);
  if (settings.guide && !(std::abs(settings.guide->norm() - 1.0) < 1e-9))
    throwBadValue("norm of the guide", settings.guide->norm(), "a unit vector");
  impl_->model.settings = settings;
}

Island::~Island() = default;
Island::Island(Island&&) noexcept = default;
Island& Island::operator=(Island&&) noexcept = default;

BodyIndex Island::addBody(const IslandBody& body) {
  checkShape(body.shape);
  checkNotNegative("body damping", body.damping);
  if (!isFinite(body.start)) throw std::invalid_argument("a body's start state must be finite");
  if (body.feels_obstacles && !std::holds_alternative<Sphere>(body.shape))
    throw std::invalid_argument("only a sphere feels obstacles; make other shapes is_rigid");
  ModelBody entry;
  entry.settings = body;
  entry.state = body.start;
  entry.bounding_radius = computeBoundingRadius(body.shape);
  if (entry.isDynamic()) {
    checkPositive("body mass", body.mass);
    entry.inverse_mass = 1.0 / body.mass;
    if (body.inertia_B != Vec3::Zero() && !impl_->model.settings.guide) {
      for (int axis = 0; axis < 3; ++axis) {
        checkNotNegative("body inertia", body.inertia_B[axis]);
        if (body.inertia_B[axis] > 0.0) entry.inverse_inertia_B[axis] = 1.0 / body.inertia_B[axis];
      }
    }
  }
  impl_->model.bodies.push_back(entry);
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

void Island::setRigidContacts(RigidContacts* rigid) { impl_->model.rigid = rigid; }

void Island::prepare() {
  Impl& impl = *impl_;
  impl.slot.reset();
  impl.spatial.reset();
  if (impl.model.settings.guide) {
    impl.slot.emplace(impl.model);
  } else {
    impl.spatial.emplace(impl.model);
  }
  impl.wrenches.resize(impl.model.bodies.size());
  impl.states.resize(impl.model.bodies.size());
  impl.prepared = true;
}

void Island::setState(BodyIndex body, const RigidState& state) noexcept {
  impl_->model.bodies[body].state = state;
}

void Island::setTarget(CouplerIndex coupler, const RigidState& target) noexcept {
  impl_->model.couplers[coupler].target = target;
}

void Island::setExternalWrench(BodyIndex body, const Vec3& f_W, const Vec3& t_W) noexcept {
  impl_->model.bodies[body].f_external_W = f_W;
  impl_->model.bodies[body].t_external_W = impl_->model.bodies[body].rotates() ? t_W : Vec3::Zero();
}

void Island::applyImpulse(BodyIndex body, const Vec3& impulse_W, const Vec3& angular_W) noexcept {
  ModelBody& b = impl_->model.bodies[body];
  b.state.v_W += b.inverse_mass * impulse_W;
  if (!b.rotates()) return;
  const Quat& q = b.state.q_WB;
  b.state.w_W += q * b.inverse_inertia_B.cwiseProduct(q.conjugate() * angular_W);
}

void Island::setObstacles(const std::vector<Obstacle>& obstacles) noexcept {
  impl_->model.obstacles = &obstacles;
}

void Island::advance(double dt) noexcept {
  Impl& impl = *impl_;
  TANDEM_ASSERT(impl.prepared);
  TANDEM_ASSERT(dt > 0.0 && dt <= impl.model.settings.haptic_period * (1.0 + 1e-9));
  if (impl.slot) {
    impl.slot->advance(impl.model, dt);
  } else {
    impl.spatial->advance(impl.model, dt);
  }
}

const RigidState& Island::state(BodyIndex body) const noexcept {
  return impl_->model.bodies[body].state;
}

int Island::bodyCount() const noexcept { return static_cast<int>(impl_->model.bodies.size()); }

bool Island::isDynamic(BodyIndex body) const noexcept {
  return impl_->model.bodies[body].isDynamic();
}

Vec3 Island::computeContactForce(BodyIndex body) const noexcept {
  TANDEM_ASSERT(impl_->prepared);
  return impl_->contactWrench(body).f_W;
}

Vec3 Island::computeCouplerForce(CouplerIndex coupler) const noexcept {
  const ModelCoupler& c = impl_->model.couplers[coupler];
  return computeCouplerWrench(c, impl_->model.bodies[c.follower].state).f_W;
}

void Island::computeWrench(BodyIndex body, Vec3& f_W, Vec3& t_W) const noexcept {
  TANDEM_ASSERT(impl_->prepared);
  const ModelBody& b = impl_->model.bodies[body];
  Wrench sum = impl_->contactWrench(body);
  sum.f_W += b.f_external_W - b.settings.damping * b.state.v_W;
  sum.t_W += b.t_external_W;
  for (const ModelCoupler& coupler : impl_->model.couplers) {
    if (coupler.follower != body) continue;
    const Wrench pull = computeCouplerWrench(coupler, b.state);
    sum.f_W += pull.f_W;
    sum.t_W += pull.t_W;
  }
  if (const auto& guide = impl_->model.settings.guide)
    sum = {*guide * guide->dot(sum.f_W), Vec3::Zero()};
  f_W = sum.f_W;
  t_W = b.rotates() ? sum.t_W : Vec3::Zero();
}

}  // namespace tandem
