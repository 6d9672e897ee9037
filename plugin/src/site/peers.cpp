#include "site/peers.h"

#include <algorithm>
#include <cmath>

#include "site/energy_port.h"
#include "site/moments.h"

namespace tandem {

Peers::Peers(const SiteSettings& settings, Island& island, Bodies& bodies, EnergyPort& energy,
             SiteLog& log)
    : settings_(settings),
      scheme_(settings.scheme ? *settings.scheme : findScheme("remote_dynamic_proxy")),
      island_(island),
      bodies_(bodies),
      energy_(energy),
      log_(log) {}

Peer Peers::make(PeerId id, Link& link, const Vec3& start_W) {
  Peer peer;
  peer.id = id;
  peer.place = count();
  peer.link = &link;
  peer.health = LinkHealth(settings_.link_loss, 1.0 / settings_.packet_rate);
  peer.acted_on = peer.health.state();
  peer.track.jump({start_W, Vec3::Zero()});
  peer.searched_W = start_W;
  peer.user = scheme_.makeRemoteUser(island_, settings_.proxy, settings_.coordination,
                                     {start_W, Vec3::Zero()});
  return peer;
}

CouplerSettings Peers::makeCoupler(const SharedObject& object) const noexcept {
  const CouplerGains& linear = settings_.coordination;
  const double radius_squared = object.bullet->inertia().maxCoeff() / object.bullet->mass();
  return {linear, settings_.angular_coordination.value_or(CouplerGains{
                      linear.stiffness * radius_squared, linear.damping * radius_squared})};
}

double Peers::nextArrival(double now, double until) noexcept {
  double earliest = kNever;
  for (Peer& peer : peers_) {
    if (!peer.pending) peer.pending = peer.link->receive(now, until);
    if (peer.pending) earliest = std::min(earliest, std::max(peer.pending->time, now));
  }
  return earliest;
}

void Peers::takeInUntil(double time, double now) noexcept {
  while (nextArrival(now, std::nextafter(time, kNever)) <= time) {
    for (Peer& peer : peers_) {
      if (!peer.pending || peer.pending->time > time) continue;
      takeIn(peer, *peer.pending, std::max(peer.pending->time, now));
      peer.pending.reset();
    }
  }
}

void Peers::takeIn(Peer& peer, const Arrival& arrival, double time) noexcept {
  const StatePacket& packet = arrival.packet;
  log_.recordArrival(peer.place, arrival);
  if (!isSane(packet) || packet.sender != peer.id) {
    ++log_.counters.packets_refused;
    log_.raise(kPacketRefused);
    return;
  }
  const bool is_latest = !peer.is_heard || packet.sequence > peer.latest.sequence;
  if (is_latest) {
    peer.is_heard = true;
    peer.latest = packet;
    hear(peer, packet, time);
    hearEnergy(peer, packet);
  }
  const bool has_news = hearObjects(peer, packet, time) || is_latest;
  ++(has_news ? log_.counters.packets_taken : log_.counters.packets_stale);
}

/// Applies a user state that is newer than all before.
void Peers::hear(Peer& peer, const StatePacket& packet, double time) noexcept {
  LinkHealth& health = peer.health;
  const PointState user{packet.user.p_W, shortenTo(packet.user.v_W, settings_.max_peer_speed)};
  const bool jumped =
      peer.motion.isJump(user.p_W, user.v_W, packet.time, time, settings_.max_peer_speed);
  const double silence = health.isOverdue(time) ? health.computeAge(time) : 0.0;
  if (health.hear(time, packet.is_idle)) {
    peer.track.jump(user);
    peer.rejoined_by = packet.sequence;
  } else {
    if (jumped) noteJump(peer);
    // A ghost touches nothing, so it may jump.
    peer.track.hear(user, time, silence, jumped && !health.isProxyOut());
  }
  scheme_.follow(island_, peer.user, peer.track.at(time, 1.0));
}

void Peers::hearEnergy(Peer& peer, const StatePacket& packet) noexcept {
  if (packet.energy) energy_.hear(peer.ledger, *packet.energy);
  if (peer.keeps_account == packet.energy.has_value()) return;
  peer.keeps_account = packet.energy.has_value();
  keep_accounts_ = std::all_of(peers_.begin(), peers_.end(),
                               [](const Peer& other) { return other.keeps_account; });
}

void Peers::noteJump(Peer& peer) noexcept {
  ++log_.counters.peer_jumps;
  peer.is_restrained = true;  // so that ticks lead its targets
}

/// An overtaken packet may still have the newest state of some object. True if it has one.
bool Peers::hearObjects(Peer& peer, const StatePacket& packet, double time) noexcept {
  bool has_news = false;
  for (std::uint32_t i = 0; i < packet.object_count; ++i) {
    const ObjectState& copy = packet.objects[i];
    if (copy.id >= peer.ties.size()) continue;
    Tie& tie = peer.ties[copy.id];
    if (tie.sequence && packet.sequence <= *tie.sequence) continue;
    const bool was_renewed = peer.isRenewed(tie);
    tie.sequence = packet.sequence;
    has_news = true;
    const bool jumped = tie.motion.isJump(copy.state.p_W, copy.state.v_W, packet.time, time,
                                          settings_.max_peer_speed);
    if (!was_renewed && peer.isRenewed(tie)) {
      tie.detour.start(island_.state(bodies_.objects[copy.id].body.index), copy.state);
    } else if (jumped) {
      noteJump(peer);
      tie.detour.start(tie.computeTarget(), copy.state);
    }
    peer.is_detouring |= !tie.detour.isOver();
    tie.theirs = limitMotion(copy.state, settings_.max_peer_speed);
    tie.velocity_share = 1.0;
    island_.setTarget(tie.coupler, tie.computeTarget());
  }
  return has_news;
}

void Peers::send(StatePacket packet, double time) noexcept {
  const auto is_live = [](const Peer& peer) { return peer.health.state() == LinkState::kLive; };
  const auto sites = 1 + static_cast<int>(std::count_if(peers_.begin(), peers_.end(), is_live));
  for (Peer& peer : peers_) {
    // A peer that may be gone is granted nothing more; its report says so.
    packet.energy = energy_.report(peer.ledger, is_live(peer) ? sites : 1);
    peer.link->send(packet, time);
  }
}

void Peers::noteSearched() noexcept {
  for (Peer& peer : peers_)
    if (peer.user.body) peer.searched_W = island_.state(*peer.user.body).p_W;
}

}  // namespace tandem
