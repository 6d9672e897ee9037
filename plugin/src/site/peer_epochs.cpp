#include <algorithm>

#include "site/peers.h"

// Epochs of objects: a copy that its host puts elsewhere begins one, and peers' copies follow.

namespace tandem {

void Peers::beginEpoch(SharedObject& object) noexcept {
  enterEpoch(object, tandem::beginEpoch(object.epoch, settings_.self));
  object.said = object.epoch;
  ++log_.counters.objects_reset;
}

/// Lets go of the copies of other epochs.
void Peers::enterEpoch(SharedObject& object, const ObjectEpoch& epoch) noexcept {
  object.epoch = epoch;
  object.awaits_put = false;
  for (const Peer& peer : peers_) {
    const Tie& tie = peer.ties[object.id];
    if (!peer.isRenewed(tie, object)) island_.setCouplerShare(tie.coupler, 0.0);
  }
}

/// Takes over a peer's newer epoch: our copy is put to the peer's copy by the next host step, or
/// follows on a detour. Hosts that do the same reset at the same time have nothing to follow.
void Peers::adopt(SharedObject& object, const ObjectState& copy, int leader) noexcept {
  const double apart = (copy.state.p_W - island_.state(object.body.index).p_W).norm();
  const bool is_same_reset =
      copy.epoch.count == object.epoch.count && apart < settings_.proxy.radius;
  enterEpoch(object, copy.epoch);
  ++log_.counters.resets_followed;
  if (is_same_reset) {
    object.said = object.epoch;
  } else if (mayPut(object)) {
    object.awaits_put = true;
    object.leader = leader;
    island_.wake();
  }
}

/// A body that Bullet moves, or that a guide holds, is led.
bool Peers::mayPut(const SharedObject& object) const noexcept {
  return settings_.puts_reset_objects && object.body.is_held &&
         settings_.contact_model == ContactModel::kIsland &&
         settings_.injection == Injection::kHandoff && !settings_.guide;
}

RigidState Peers::findPlace(const SharedObject& object) const noexcept {
  return peers_[static_cast<std::size_t>(object.leader)].ties[object.id].theirs;
}

void Peers::finishPut(SharedObject& object) noexcept {
  if (!object.awaits_put) return;
  object.awaits_put = false;
  object.said = object.epoch;
  for (Peer& peer : peers_) {
    Tie& tie = peer.ties[object.id];
    if (!peer.isRenewed(tie, object)) continue;
    tie.detour.start(island_.state(object.body.index), tie.theirs);
    peer.is_detouring |= !tie.detour.isOver();
    peer.is_restrained = true;  // so that ticks lead its targets
    island_.setTarget(tie.coupler, tie.computeTarget());
    island_.setCouplerShare(tie.coupler, tieShare(peer));
  }
}

void Peers::sayEpochs() noexcept {
  for (SharedObject& object : bodies_.objects)
    if (!object.awaits_put && object.said != object.epoch && !isLed(object))
      object.said = object.epoch;
}

/// True while our copy is on its way to a peer's copy of a newer epoch. A silent peer leads nobody.
bool Peers::isLed(const SharedObject& object) const noexcept {
  const Vec3& ours_W = island_.state(object.body.index).p_W;
  return std::any_of(peers_.begin(), peers_.end(), [&](const Peer& peer) {
    const Tie& tie = peer.ties[object.id];
    const LinkState link = peer.health.state();
    return object.body.is_held && peer.isRenewed(tie, object) && !tie.detour.isOver() &&
           link != LinkState::kLost && link != LinkState::kWaiting &&
           (tie.theirs.p_W - ours_W).norm() >= settings_.proxy.radius;
  });
}

}  // namespace tandem
