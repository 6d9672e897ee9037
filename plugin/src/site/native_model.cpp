#include "site/native_model.h"

#include "bullet_bridge/src/bodies/haptic_body.h"
#include "bullet_bridge/src/bodies/sphere_body.h"

namespace tandem {
namespace {

NativeCouplerKind couplerKind(ContactModel model) {
  if (model == ContactModel::kSpring6Dof) return NativeCouplerKind::kSpring6Dof;
  if (model == ContactModel::kPointToPoint) return NativeCouplerKind::kPointToPoint;
  return NativeCouplerKind::kImpulse;
}

}  // namespace

NativeModel::NativeModel(btDiscreteDynamicsWorld& world, const SiteSettings& settings,
                         const Vec3& hand_W)
    : world_(world), settings_(settings), hand_(world, settings.hip_radius, hand_W) {}

NativeModel::~NativeModel() {
  for (const Object& object : objects_) {
    if (!object.bullet->isInWorld()) continue;
    object.bullet->endModelDamping();
    btRigidBody& body = object.bullet->body();
    if (object.may_sleep && body.getActivationState() == DISABLE_DEACTIVATION)
      body.forceActivationState(ACTIVE_TAG);
  }
}

void NativeModel::addObject(const HapticBody& object, double damping) {
  setNativeDamping(object.body(), damping);
  objects_.push_back({&object, object.body().getActivationState() != DISABLE_DEACTIVATION});
  object.body().setActivationState(DISABLE_DEACTIVATION);
  guide(object.body());
  soften(hand_.rigid());
}

void NativeModel::addProxy(BodyIndex body, const SphereBody& proxy,
                           const StandInSettings& stand_in) {
  proxies_.push_back({body, &proxy.rigid()});
  proxy.rigid().setActivationState(DISABLE_DEACTIVATION);
  setNativeDamping(proxy.rigid(), stand_in.proxy.damping);
  guide(proxy.rigid());
  soften(proxy.rigid(), stand_in.share);
}

KinematicSphere& NativeModel::addHeldProxy(BodyIndex body, const Vec3& p_W,
                                           const StandInSettings& stand_in) {
  held_.push_back({body, std::make_unique<KinematicSphere>(world_, settings_.proxy.radius, p_W)});
  soften(held_.back().sphere->rigid(), stand_in.share);
  return *held_.back().sphere;
}

void NativeModel::addCoupler(btRigidBody& body, CouplerIndex index, CouplerSettings coupler) {
  if (settings_.guide) coupler.angular = {};
  couplers_.push_back(
      {index, makeNativeCoupler(couplerKind(settings_.contact_model), world_, body, coupler)});
}

void NativeModel::guide(btRigidBody& body) {
  if (settings_.guide) guides_.push_back(std::make_unique<NativeGuide>(body, *settings_.guide));
}

void NativeModel::soften(btRigidBody& sphere, double share) const {
  const CouplerGains& full = settings_.contact;
  if (settings_.contact_model != ContactModel::kNativeRigid)
    setSoftContact(sphere, {share * full.stiffness, share * full.damping});
}

void NativeModel::followShares(const Island& island) noexcept {
  for (const Coupled& coupled : couplers_)
    coupled.coupler->setShare(island.couplerShare(coupled.index));
  for (const Held& held : held_) soften(held.sphere->rigid(), island.contactShare(held.body));
  for (const Proxy& proxy : proxies_) {
    soften(*proxy.rigid, island.contactShare(proxy.body));
    setNativeDamping(*proxy.rigid,
                     island.body(proxy.body).damping + island.extraDamping(proxy.body));
  }
}

bool NativeModel::isPresent() const noexcept {
  bool present = hand_.isInWorld();
  for (const Held& held : held_) present &= held.sphere->isInWorld();
  return present;
}

void NativeModel::beginStep(const Island& island, const Vec3& hand_end_W, double dt) noexcept {
  hand_.moveTo(hand_end_W, dt);
  for (const Held& held : held_) held.sphere->hold(island.state(held.body).point());
  for (const Coupled& coupled : couplers_) coupled.coupler->pull(island.target(coupled.index), dt);
}

void NativeModel::endStep(double dt) noexcept {
  hand_force_W_ = computeContactImpulse(world_, hand_.rigid()) / dt;
  hand_.arrive();
}

}  // namespace tandem
