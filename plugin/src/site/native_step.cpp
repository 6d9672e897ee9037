#include "site/native_step.h"

#include <algorithm>

namespace tandem {

NativeStep::NativeStep(SiteParts& parts)
    : site_(parts),
      model_(std::make_unique<NativeModel>(parts.host_world.world(), parts.settings,
                                           parts.hand.sample().hip.p_W)) {}

void NativeStep::addObject(SharedObject& object) {
  model_->addObject(*object.bullet, object.damping);
}

void NativeStep::addProxy(Peer& peer, const Vec3& start_W) {
  const BodyIndex index = *peer.user.body;
  if (!peer.user.coupler) {
    peer.proxy.held = &model_->addHeldProxy(index, start_W, site_.peers.standIn());
    return;
  }
  const StandInSettings& stand_in = site_.peers.standIn();
  const ProxySettings& proxy = stand_in.proxy;
  peer.proxy.sphere = std::make_unique<SphereBody>(site_.host_world.world(), proxy.radius,
                                                   proxy.mass, start_W, SphereMeets::kAllBodies);
  peer.proxy.body.bullet = &peer.proxy.sphere->haptic();
  peer.proxy.body.index = index;
  model_->addProxy(index, *peer.proxy.sphere, stand_in);
  model_->addCoupler(peer.proxy.sphere->rigid(), *peer.user.coupler, {stand_in.coordination, {}});
}

void NativeStep::addCoupler(SharedObject& object, CouplerIndex index,
                            const CouplerSettings& coupler) {
  model_->addCoupler(*object.rigid, index, coupler);
}

const Vec3& NativeStep::computeContactForce() noexcept {
  static const Vec3 kNone = Vec3::Zero();
  return model_ ? model_->handForce() : kNone;
}

void NativeStep::advance(double now, double end) noexcept {
  site_.sender.sendIfDue(now, false);
  site_.timeline.passTo(end);
}

bool NativeStep::isPlaceFree(const Peer& peer, double unknown) const noexcept {
  const btRigidBody* rigid = peer.proxy.findRigid();
  return rigid && computeNativeOverlap(site_.host_world.world(), *rigid) + unknown <=
                      site_.settings.link_loss.rejoin_overlap;
}

void NativeStep::showProxy(Peer& peer) noexcept {
  const BodyIndex index = *peer.user.body;
  peer.proxy.show(site_.island.state(index), site_.island.isGhost(index));
}

void NativeStep::before(double dt) noexcept {
  if (!areBodiesPresent()) return site_.passStepWithout(dt);
  site_.followHostClock(dt);
  site_.noteTeleports();
  const double end = site_.clock.time() + dt;
  if (site_.ticksInHostStep()) site_.runTicksUntil(end);
  site_.clock.setStep(dt);
  // The hand moves on from its latest sample, as it does in the island.
  const RigidState& hand = site_.island.state(site_.hand.hip());
  const double ahead = std::max(0.0, end - site_.timeline.tickStart());
  if (site_.settings.link_loss.enabled) model_->followShares(site_.island);
  holdGhosts();
  model_->beginStep(site_.island, hand.p_W + ahead * hand.v_W, dt);
}

void NativeStep::after(double dt) noexcept {
  site_.clock.endStep(dt);
  if (!areBodiesPresent()) return;
  model_->endStep(dt);
  holdGhosts();
  site_.bodies.forEach(
      [&](SiteBody& body) { site_.island.setState(body.index, body.bullet->state()); });
  site_.peers.noteSearched();
}

bool NativeStep::areBodiesPresent() noexcept {
  if (!model_->isPresent()) {
    site_.log.stop(kBodyMissing);
    return false;
  }
  return site_.areBodiesPresent();
}

/// Keeps ghosts in place; Bullet would move them.
void NativeStep::holdGhosts() noexcept {
  for (Peer& peer : site_.peers) {
    if (!peer.proxy.sphere || !site_.island.isGhost(peer.proxy.body.index)) continue;
    RigidState state = site_.island.state(peer.proxy.body.index);
    state.v_W.setZero();
    peer.proxy.body.bullet->setState(state);
  }
}

}  // namespace tandem
