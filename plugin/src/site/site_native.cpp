// The host's step with a native contact model. Beside site_host.cpp, which has it for the island:
//
//   pre-tick    the hand's sphere gets its way over this step; held proxies and couplers, the
//               states that packets brought
//   Bullet      moves everything
//   post-tick   contact impulses become the force on the device until the next host step;
//               bodies' states go to the island, where the tick finds them

#include <algorithm>

#include "site/site_impl.h"

namespace tandem {

void Site::Impl::addNativeProxy(Remote& remote, const Vec3& start_W) {
  const BodyIndex index = *remote.user.body;
  if (!remote.user.coupler) {
    remote.held_proxy = &native->addHeldProxy(index, start_W);
    return;
  }
  remote.proxy =
      std::make_unique<SphereBody>(host_world.world(), settings.proxy.radius, settings.proxy.mass,
                                   start_W, SphereMeets::kAllBodies);
  remote.body.bullet = &remote.proxy->haptic();
  remote.body.index = index;
  native->addProxy(index, *remote.proxy);
  native->addCoupler(remote.proxy->rigid(), *remote.user.coupler, {settings.coordination, {}});
}

void Site::Impl::beforeNativeStep(double dt) noexcept {
  const double end = host_time + dt;
  if (settings.tick_source == TickSource::kHostStep) runTicksUntil(end);
  host_step = dt;
  // The hand goes on from its latest sample, as it does in the island.
  const RigidState& hand = island.state(hip);
  const double ahead = std::max(0.0, end - tick_start);
  if (settings.link_loss.enabled) native->followShares(island);
  holdNativeGhosts();
  native->beginStep(island, hand.p_W + ahead * hand.v_W, dt);
}

void Site::Impl::afterNativeStep(double dt) noexcept {
  native->endStep(dt);
  holdNativeGhosts();
  forEachBody([&](SiteBody& body) { island.setState(body.index, body.bullet->state()); });
  noteSearched();
}

/// Bullet would move them on.
void Site::Impl::holdNativeGhosts() noexcept {
  for (Remote& remote : remotes) {
    if (!remote.proxy || !island.isGhost(remote.body.index)) continue;
    RigidState state = island.state(remote.body.index);
    state.v_W.setZero();
    remote.body.bullet->setState(state);
  }
}

}  // namespace tandem
