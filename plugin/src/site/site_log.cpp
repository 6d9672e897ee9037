#include "site/site_log.h"

#include <cmath>

#include "site/local_hand.h"
#include "site/peers.h"

namespace tandem {

bool areAwakeFinite(const Island& island) noexcept {
  // A sum is finite only if all its terms are.
  double sum = 0.0;
  for (const BodyIndex b : island.awakeBodies()) {
    const RigidState& state = island.state(b);
    sum += 0.0 * (state.p_W.sum() + state.v_W.sum() + state.w_W.sum() + state.q_WB.coeffs().sum());
  }
  return std::isfinite(sum);
}

void SiteLog::addToHash(double now, const Vec3& force_W, const Island& island) noexcept {
  hash_.add(now);
  hash_.add(force_W);
  if (hash_rest_.holds(island)) return;
  hash_rest_.set(island);
  for (const BodyIndex b : island.awakeBodies()) hash_.add(island.state(b));
}

void SiteLog::countForces(const LocalHand& hand) noexcept {
  counters.force_clamped = hand.guard().clampedCount();
  counters.force_slewed = hand.guard().slewedCount();
  counters.energy_limited = hand.energy().limitedCount();
}

void SiteLog::recordTick(double now, const LocalHand& hand, const Bodies& bodies,
                         const Peers& peers, const Island& island, bool reads_bullet) noexcept {
  const auto fill = [&](const SiteBody& body, BodyRecord& record) {
    record.island = island.state(body.index);
    record.bullet =
        reads_bullet && body.bullet && !body.is_leaving ? body.bullet->state() : body.seen;
  };
  for (std::size_t i = 0; i < bodies.objects.size(); ++i) fill(bodies.objects[i].body, objects_[i]);
  for (const Peer& peer : peers) {
    BodyRecord& record = proxies_[static_cast<std::size_t>(peer.place)];
    if (peer.proxy.sphere) fill(peer.proxy.body, record);
    if (peer.proxy.held) record = {island.state(*peer.user.body), peer.proxy.held->state()};
  }
  recording->addTick({now, hand.sample(), hand.force(), hand.contact() != Vec3::Zero()},
                     objects_.data(), proxies_.data());
}

void SiteLog::makeRoom(std::size_t objects, std::size_t peers) {
  hash_rest_.clear();
  objects_.resize(objects);
  proxies_.resize(peers);
}

}  // namespace tandem
