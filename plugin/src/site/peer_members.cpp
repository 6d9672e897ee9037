#include <algorithm>

#include "site/energy_port.h"
#include "site/peers.h"

// Sites that come and go: Membership agrees on them; this file gives each its share.
//
//   masses       m/N at the next host step, at the velocity that the copy has
//   gains        move within LinkLossSettings::ramp_in
//   who joins    takes over the others' objects, as from a reset, and is tied then

namespace tandem {

void Peers::followMembers(double now) noexcept {
  if (!membership_.follows()) return;
  for (const Peer& peer : peers_)
    if (peer.link->hasLeft()) membership_.forget(peer.id);
  const std::optional<PeerId> before = membership_.leader();
  if (membership_.agree(now)) beginSharing(now);
  if (membership_.leader() != before) beginJoin();
  if (!ramp_.isOver()) moveShares(now);
  for (Peer& peer : peers_)
    if (peer.is_counted != membership_.isTied(peer.id, peer.is_counted)) count(peer);
  if (membership_.leader()) followJoin();
}

/// Others take part than before.
void Peers::beginSharing(double now) noexcept {
  ++log_.counters.members_changed;
  ramp_.start(shares_, computeShares(settings_.coordination_mode, countSites()), now);
  island_.wake();
}

/// All objects are taken over from another leader, or from none.
void Peers::beginJoin() noexcept {
  const std::optional<PeerId>& leader = membership_.leader();
  for (SharedObject& object : bodies_.objects) object.joins = leader && !object.tool_of;
  if (Peer* peer = leader ? find(*leader) : nullptr) peer->counted_at = peer->packets_heard;
}

void Peers::moveShares(double now) noexcept {
  shares_ = ramp_.at(now);
  stand_in_ = makeStandIn(settings_.proxy, settings_.coordination, shares_.stand_in);
  for (Peer& peer : peers_) {
    applyStandIn(peer);
    peer.is_restrained = true;  // so that followLinks() applies the shares
  }
}

void Peers::applyStandIn(const Peer& peer) noexcept {
  if (!peer.user.body || !peer.user.coupler) return;
  const ProxySettings& proxy = stand_in_.proxy;
  const IslandBody& body = island_.body(*peer.user.body);
  const RigidState& state = island_.state(*peer.user.body);
  energy_.countNeighbour(body, state, -1.0);
  island_.setMass(*peer.user.body, proxy.mass, body.inertia_B, proxy.damping);
  energy_.countNeighbour(body, state, 1.0);
}

/// Begins or ends to count a peer. Its next packet then begins as after a silence.
void Peers::count(Peer& peer) noexcept {
  peer.is_counted = !peer.is_counted;
  peer.counted_at = peer.packets_heard;
  if (peer.is_counted) return;
  peer.health.await();
  peer.is_restrained = true;  // so that followLinks() lets go of it
}

void Peers::followJoin() noexcept {
  const Peer* leader = find(*membership_.leader());
  // Until it counts us its copies may still be others' than those of the group.
  if (leader && !leader->is_counted) return;
  bool is_over = true;
  for (SharedObject& object : bodies_.objects) {
    if (leader && mustJoin(object, *leader)) join(object, *leader);
    object.joins = object.joins && leader && mayYetTell(*leader);
    is_over &= !object.joins && !object.awaits_put && !isLed(object);
  }
  if (is_over) membership_.endJoin();
}

/// False if the leader has had time enough to tell all objects that it shares.
bool Peers::mayYetTell(const Peer& leader) const noexcept {
  return leader.packets_heard - leader.counted_at < findPatience(leader);
}

/// True if the leader has told the object since it counts us. Before, it was perhaps elsewhere.
bool Peers::mustJoin(const SharedObject& object, const Peer& leader) const noexcept {
  const Tie& tie = leader.ties[object.id];
  return object.joins && tie.sequence && tie.heard_at >= leader.counted_at;
}

/// Takes over the leader's copy, whatever the epoch of ours.
void Peers::join(SharedObject& object, const Peer& leader) noexcept {
  object.joins = false;
  enterEpoch(object, leader.ties[object.id].epoch);
  if (!mayPut(object)) return;
  object.awaits_put = true;
  object.leader = leader.place;
  island_.wake();
}

Peer* Peers::find(PeerId id) noexcept {
  const auto at =
      std::find_if(peers_.begin(), peers_.end(), [&](const Peer& peer) { return peer.id == id; });
  return at == peers_.end() ? nullptr : &*at;
}

}  // namespace tandem
