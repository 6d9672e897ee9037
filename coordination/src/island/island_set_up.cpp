#include <cmath>
#include <stdexcept>
#include <string>

#include "bad_value.h"
#include "island/guide_lines.h"
#include "island/island_impl.h"
#include "tandem_assert.h"

namespace tandem {
namespace {

/// Most contacts that were let in and still push with less than their overlap, and most faces that
/// spheres touch.
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
  checkPositive("body contact share", body.contact_share);
  if (!isFinite(body.start)) throw std::invalid_argument("a body's start state must be finite");
  if (body.feels_obstacles && !std::holds_alternative<Sphere>(body.shape))
    throw std::invalid_argument("only a sphere feels obstacles; make other shapes is_rigid");
  if (body.motion != Motion::kDynamic) return;
  checkPositive("body mass", body.mass);
  if (is_guided) return;
  for (int axis = 0; axis < 3; ++axis) {
    checkNotNegative("body inertia", body.inertia_B[axis]);
    checkNotNegative("body linear factor", body.linear_factor[axis]);
    checkNotNegative("body angular factor", body.angular_factor[axis]);
  }
}

}  // namespace

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
  impl_->model.bodies.push_back(ModelBody::makeEmpty(true));
  impl_->model.slots.push_back(bodyCount() - 1);
  impl_->prepared = false;
  return bodyCount() - 1;
}

GripIndex Island::addGrip(BodyIndex hand) {
  TANDEM_ASSERT(hand >= 0 && hand < bodyCount());
  if (impl_->model.settings.guide)
    throw std::invalid_argument("a guided island has no grips; leave the guide off");
  ModelGrip grip;
  grip.hand = hand;
  impl_->model.grips.push_back(grip);
  impl_->prepared = false;
  return static_cast<GripIndex>(impl_->model.grips.size()) - 1;
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

void Island::setFilter(BodyIndex body, const CollisionFilter& filter) {
  impl_->model.bodies[static_cast<std::size_t>(body)].settings.filter = filter;
  impl_->model.is_listed = false;
}

void Island::addContact(BodyIndex sphere, BodyIndex other, const CouplerGains& gains) {
  TANDEM_ASSERT(sphere >= 0 && sphere < bodyCount() && other >= 0 && other < bodyCount() &&
                sphere != other);
  if (!std::holds_alternative<Sphere>(impl_->model.bodies[sphere].settings.shape))
    throw std::invalid_argument("smooth contact is between a sphere and another body");
  checkGains("contact", gains);
  if (impl_->model.settings.guide && !canMeet(impl_->model, sphere, other)) return;
  impl_->model.contacts.push_back({sphere, other, gains});
  impl_->prepared = false;
}

void Island::setTouchMemory(bool remembers) noexcept {
  impl_->model.remembers_touches = remembers;
  if (remembers) return;
  impl_->model.has_jumps = false;
  impl_->model.memory.clear();
  impl_->model.faces = {};
}

void Island::setContactFinder(ContactFinder* finder) {
  impl_->model.finder = finder;
  wake();
}

void Island::setJointSource(JointSource* joints) {
  impl_->model.joints = joints;
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
  if (impl.model.finder) impl.touching.reserve(kMaxRigidContacts);
  for (ModelBody& body : impl.model.bodies) body.is_asleep = false;
  impl.model.memory.makeRoom(kMostRemembered);
  if (impl.model.remembers_touches) impl.model.faces.makeRoom(kMostRemembered);
  impl.noteJumps();
  impl.model.reserveLists();
  impl.model.listPresent();
  impl.catch_up.prepare(impl.model);
  impl.prepared = true;
}

}  // namespace tandem
