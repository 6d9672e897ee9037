#include "site/site_impl.h"

namespace tandem {

void Site::Impl::beforeHostStep(double dt) noexcept {
  ++log.counters.host_steps;
  if (log.hasDiverged() && !has_given_back_ && settings.contact_model == ContactModel::kIsland)
    giveBack(false);
  if (has_given_back_) return desk.run([&] { passStepWithout(dt); });
  surroundings.hideContacts();
  host_step->before(dt);
}

void Site::Impl::afterHostStep(double dt) noexcept {
  if (has_given_back_) return desk.run([&] { clock.endStep(dt); });
  host_step->after(dt);
  surroundings.unhideContacts();
}

/// The host destroys its world while a site is attached. This call gives everything back while
/// bodies and broadphase still exist. The world is not touched afterwards.
void Site::Impl::hostWorldEnds() noexcept {
  log.raiseFromHost(kWorldGone);
  giveBack(true);
}

/// Gives the host's bodies back. Unless its world ends, proxies stay in it, and touch nothing.
void Site::Impl::giveBack(bool world_ends) {
  has_given_back_ = true;
  host_step->leaveNeighbours();
  keepLastLook();
  surroundings.forgetWorld();

  // These restore Bullet's bodies when destroyed. By then no tick refers to them.
  std::vector<std::unique_ptr<HapticBody>> shared;
  std::vector<std::unique_ptr<SphereBody>> spheres;
  shared.reserve(bodies.objects.size());
  spheres.reserve(static_cast<std::size_t>(peers.count()));
  desk.run([&] {
    surroundings.takeObstacles();
    for (SharedObject& object : bodies.objects) {
      shared.push_back(std::move(object.bullet));
      object.body.bullet = nullptr;
    }
    if (!world_ends) return;
    for (Peer& peer : peers) {
      spheres.push_back(std::move(peer.proxy.sphere));
      peer.proxy.held = nullptr;
      peer.proxy.body.bullet = nullptr;
    }
  });
  for (const Peer& peer : peers)
    if (btRigidBody* rigid = peer.proxy.findRigid()) setNativeGhost(*rigid, true);
  if (world_ends) host_step->leaveWorld();
  spheres.clear();
  shared.clear();
}

/// Keeps the last state of each body and its warnings.
void Site::Impl::keepLastLook() {
  bodies.forEach([&](SiteBody& body) {
    if (!body.bullet) return;
    log.warnings.insert(log.warnings.end(), body.bullet->warnings().begin(),
                        body.bullet->warnings().end());
    if (!desk.isOpen() && body.bullet->isInWorld()) body.seen = body.bullet->state();
  });
}

std::vector<std::string> Site::Impl::warnings() const {
  std::vector<std::string> all = host_world.warnings();
  all.insert(all.end(), log.warnings.begin(), log.warnings.end());
  bodies.forEach([&](const SiteBody& body) {
    if (!body.bullet) return;
    all.insert(all.end(), body.bullet->warnings().begin(), body.bullet->warnings().end());
  });
  if (has_given_back_) return all;
  objects.explain(all);
  surroundings.explain(all);
  return all;
}

}  // namespace tandem
