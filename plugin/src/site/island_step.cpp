#include "site/island_step.h"

namespace tandem {
namespace {

/// Obstacles are known up to this distance from the place of the last search [m].
constexpr double kKnownAround = 0.02;

/// Snapshots kept in addition to those that a late host may ask for.
constexpr std::size_t kSpareMoments = 4;

/// Before the first tick, surroundings are searched once in this many host steps.
constexpr int kStepsBetweenLooks = 64;

}  // namespace

IslandStep::IslandStep(SiteParts& parts) : site_(parts) {
  site_.surroundings.addSphere(site_.hand.hip(), site_.settings.hip_radius);
}

void IslandStep::addObject(SharedObject& object) {
  const CouplerGains& contact = site_.settings.contact;
  site_.surroundings.exclude(*object.rigid);
  site_.island.addContact(site_.hand.hip(), object.body.index, contact);
  for (Peer& peer : site_.peers) {
    if (!peer.proxy.sphere) continue;
    site_.island.addContact(*peer.user.body, object.body.index, contact);
    if (btRigidBody* proxy = peer.proxy.findRigid())
      filterNativeContact(site_.host_world.world(), *proxy, *object.rigid, true);
  }
}

void IslandStep::addProxy(Peer& peer, const Vec3& start_W) {
  const ProxySettings& proxy = site_.peers.standIn().proxy;
  const CouplerGains& contact = site_.settings.contact;
  const BodyIndex index = *peer.user.body;
  const CollisionFilter filter{site_.settings.hand_group, site_.settings.hand_mask};
  peer.proxy.sphere =
      std::make_unique<SphereBody>(site_.host_world.world(), proxy.radius, proxy.mass, start_W,
                                   SphereMeets::kMovingBodies, filter);
  peer.proxy.address = &peer.proxy.sphere->rigid();
  site_.surroundings.exclude(*peer.proxy.address);
  peer.proxy.body.bullet = &peer.proxy.sphere->haptic();
  peer.proxy.body.index = index;
  site_.surroundings.addSphere(index, proxy.radius);
  site_.island.addContact(site_.hand.hip(), index, contact);
  for (SharedObject& object : site_.bodies.objects) {
    site_.island.addContact(index, object.body.index, contact);
    if (object.body.is_held)
      filterNativeContact(site_.host_world.world(), peer.proxy.sphere->rigid(), *object.rigid,
                          true);
  }
}

/// Without a guide, a body that is missing leaves alone.
bool IslandStep::areBodiesPresent() noexcept {
  if (site_.settings.guide) return site_.areBodiesPresent();
  site_.objects.findChanged();
  site_.objects.takeLeaving();
  site_.objects.giveBack();
  return true;
}

void IslandStep::finishSetUp() {
  const double step = site_.clock.expectedStep();
  makeRoomFor(step);
  lookAround(step);
}

bool IslandStep::isPlaceFree(const Peer& peer, double unknown) const noexcept {
  if (!site_.settings.guide && unknown > kKnownAround) return false;
  return site_.island.computeOverlap(*peer.user.body) <= site_.settings.link_loss.rejoin_overlap;
}

void IslandStep::leaveNeighbours() {
  site_.rest.disturb();
  site_.surroundings.leaveAll();
  site_.desk.run([&] { site_.surroundings.takeLeaving(); });
  site_.surroundings.giveBack();
}

/// With a haptic thread the tick count must not be read here.
bool IslandStep::isWaiting() const noexcept {
  return !site_.desk.isOpen() && !site_.timeline.hasBegun() && site_.isBare() &&
         !site_.ticksInHostStep();
}

void IslandStep::wait(double dt) {
  site_.clock.endStep(dt);
  site_.clock.setStep(dt);
  site_.timeline.announceAfterNow(site_.clock.time() + dt, dt);
  if (++waited_ % kStepsBetweenLooks == 0) lookAround(dt);
}

void IslandStep::lookAround(double dt) {
  Surroundings& around = site_.surroundings;
  site_.desk.run([&] { around.mirror(); });
  // Before the first tick the hand touches nothing, and Bullet moves all bodies.
  around.holdNeighbours(!isWaiting());
  around.look(dt, site_.clock.time(), 0.0, true);
  around.holdNeighbours(true);
  site_.desk.run([&] { around.take(); });
  around.giveBack();
  if (!around.mustLookFarther()) return;
  around.lookFarther();
  site_.desk.run([&] { around.takeObstacles(); });
}

void IslandStep::makeRoomFor(double dt) {
  if (dt > 0.0)
    site_.timeline.makeRoom(static_cast<std::size_t>(site_.surroundings.computeHorizon(dt) / dt) +
                            kSpareMoments);
}

}  // namespace tandem
