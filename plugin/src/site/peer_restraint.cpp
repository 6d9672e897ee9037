#include <algorithm>

#include "site/host_step.h"
#include "site/peers.h"

// Reduces the influence of a silent peer. LinkHealth decides; this file applies it.

namespace tandem {

void Peers::followLinks(double now, double period, HostStep& host_step) noexcept {
  const bool may_fade = settings_.link_loss.enabled;
  for (Peer& peer : peers_) {
    if (!peer.is_restrained && !(may_fade && !peer.health.staysLive(now))) continue;
    may_fade ? followLink(peer, now, period, host_step) : followJump(peer, now, period);
  }
}

/// Leads a peer that always counts as live to where its states jumped.
void Peers::followJump(Peer& peer, double now, double period) noexcept {
  if (peer.is_detouring) followDetours(peer, period);
  scheme_.follow(island_, peer.user, peer.track.at(now, 1.0));
  peer.is_restrained = peer.is_detouring || peer.track.isMakingUp(now);
}

void Peers::followLink(Peer& peer, double now, double period, HostStep& host_step) noexcept {
  LinkHealth& health = peer.health;
  if (health.isProxyOut() && health.state() == LinkState::kRejoining) carryGhost(peer, now);
  health.update(now, !health.isProxyOut() || mayComeIn(peer, host_step));
  const LinkState state = health.state(), before = peer.acted_on;
  peer.acted_on = state;
  if (state != before) countLinks();

  const bool is_silent = state == LinkState::kLost || state == LinkState::kWaiting;
  const bool is_heard = state == LinkState::kLive || state == LinkState::kRejoining;
  if (is_heard && peer.is_detouring) followDetours(peer, period);
  const bool is_calm =
      state == LinkState::kLive && !peer.track.isMakingUp(now) && !peer.is_detouring;
  if (peer.is_restrained ? is_silent && state == before : is_calm) return;
  peer.is_restrained = !is_calm;

  slowTargets(peer);
  if (!health.isProxyOut())
    scheme_.follow(island_, peer.user, peer.track.at(now, health.velocityShare()));
  restrainTies(peer);
  restrainProxy(peer, host_step);
}

void Peers::countLinks() noexcept {
  SiteCounters& counters = log_.counters;
  counters.links_faded = counters.links_lost = counters.links_rejoined = 0;
  for (const Peer& peer : peers_) {
    const LinkCounters& of_link = peer.health.counters();
    counters.links_faded += of_link.faded;
    counters.links_lost += of_link.lost;
    counters.links_rejoined += of_link.rejoined;
  }
}

/// True if the proxy's place is free, as far as that is known, and objects are where the user has
/// them. Otherwise the proxy might return on the wrong side of an object and hold it off its
/// target.
bool Peers::mayComeIn(const Peer& peer, const HostStep& host_step) const noexcept {
  if (!peer.user.body) return true;
  const bool may_yet_agree = peer.health.objectShare() < 1.0 || peer.is_detouring;
  if (may_yet_agree && !doCopiesAgree(peer)) return false;
  const double unknown = (island_.state(*peer.user.body).p_W - peer.searched_W).norm();
  return host_step.isPlaceFree(peer, unknown);
}

bool Peers::doCopiesAgree(const Peer& peer) const noexcept {
  return std::all_of(bodies_.objects.begin(), bodies_.objects.end(),
                     [&](const SharedObject& object) {
                       const Tie& tie = peer.ties[object.id];
                       const Vec3& ours_W = island_.state(object.body.index).p_W;
                       return peer.isRenewed(tie, object) &&
                              (tie.theirs.p_W - ours_W).norm() < settings_.proxy.radius;
                     });
}

/// Moves a ghost that may return to the user's position.
void Peers::carryGhost(const Peer& peer, double now) noexcept {
  if (!peer.user.body) return;
  const PointState user = peer.track.at(now, peer.health.velocityShare());
  RigidState state = island_.state(*peer.user.body);
  state.p_W = user.p_W;
  state.v_W = user.v_W;
  island_.setState(*peer.user.body, state);
}

/// Slows the targets of shared objects while the peer is silent. A target keeps the slowing that it
/// already has, until a packet renews it.
void Peers::slowTargets(Peer& peer) noexcept {
  const double share = peer.health.velocityShare();
  for (Tie& tie : peer.ties) {
    if (share >= tie.velocity_share) continue;
    tie.velocity_share = share;
    island_.setTarget(tie.coupler, tie.computeTarget());
  }
}

void Peers::followDetours(Peer& peer, double period) noexcept {
  peer.is_detouring = false;
  for (Tie& tie : peer.ties) {
    if (tie.detour.isOver()) continue;
    tie.detour.advance(period);
    peer.is_detouring |= !tie.detour.isOver();
    island_.setTarget(tie.coupler, tie.computeTarget());
  }
}

void Peers::restrainTies(const Peer& peer) noexcept {
  const double share = tieShare(peer);
  for (std::size_t i = 0; i < peer.ties.size(); ++i) {
    const Tie& tie = peer.ties[i];
    const bool acts = peer.isRenewed(tie, bodies_.objects[i]);
    island_.setCouplerShare(tie.coupler, acts ? share : 0.0);
  }
}

void Peers::restrainProxy(Peer& peer, HostStep& host_step) noexcept {
  if (!peer.user.body) return;
  const BodyIndex body = *peer.user.body;
  const LinkHealth& health = peer.health;
  const bool is_out = health.isProxyOut();
  if (is_out != island_.isGhost(body)) {
    island_.setGhost(body, is_out);
    if (is_out) {
      RigidState state = island_.state(body);
      state.v_W.setZero();
      island_.setState(body, state);
    }
    host_step.showProxy(peer);
  }
  const double share = health.proxyShare() * shares_.stand_in / base_.stand_in;
  island_.setContactShare(body, share);
  if (!peer.user.coupler) return;
  const double rest_damping = computeRestDamping(stand_in_.coordination, stand_in_.proxy.mass,
                                                 settings_.link_loss.hold_decay);
  island_.setCouplerShare(*peer.user.coupler, share);
  island_.setExtraDamping(body, is_out ? 0.0 : health.silence() * rest_damping);
}

}  // namespace tandem
