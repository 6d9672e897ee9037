#include "site/peers.h"

#include <algorithm>
#include <cmath>

#include "site/energy_port.h"
#include "site/moments.h"
#include "site/teleport.h"

namespace tandem {
namespace {

/// An object counts as missing at the peer after so many packets without it. Packets overtake, and
/// a body may be too fast for packets for a moment.
constexpr std::size_t kPacketsMissed = 16;
/// Rounds of one object a packet that may be missed, if not all fit: a round may be lost in part.
constexpr std::size_t kRoundsMissed = 4;

}  // namespace

Peers::Peers(const SiteSettings& settings, Island& island, Bodies& bodies, EnergyPort& energy,
             SiteLog& log)
    : settings_(settings),
      scheme_(settings.scheme ? *settings.scheme : findScheme("remote_dynamic_proxy")),
      membership_(settings.self, settings.membership),
      base_(computeShares(settings.coordination_mode, countSites())),
      ramp_(base_, settings.link_loss.ramp_in),
      shares_(base_),
      stand_in_(makeStandIn(settings.proxy, settings.coordination, shares_.stand_in)),
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
  peer.is_counted = !membership_.follows();
  if (!peer.is_counted) peer.health.await();
  peer.acted_on = peer.health.state();
  peer.track.jump({start_W, Vec3::Zero()});
  peer.searched_W = start_W;
  peer.user = scheme_.makeRemoteUser(island_, stand_in_, {start_W, Vec3::Zero()});
  if (peer.user.body)
    island_.setFilter(*peer.user.body, {settings_.hand_group, settings_.hand_mask});
  return peer;
}

double Peers::findMassShare(const std::optional<PeerId>& tool_of) const noexcept {
  if (!tool_of) return 1.0 / countSites();
  return *tool_of == settings_.self ? 1.0 : stand_in_.share;
}

CouplerSettings Peers::makeCoupler(const SharedObject& object) const noexcept {
  if (object.tool_of) return {};
  const CouplerGains& linear = settings_.coordination;
  const double radius_squared = object.settings.inertia_B.maxCoeff() / object.settings.mass;
  const CouplerGains angular =
      settings_.angular_coordination.value_or(computeShare(linear, radius_squared));
  return {computeShare(linear, base_.object), computeShare(angular, base_.object)};
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

void Peers::takeIn(Peer& peer, Arrival& arrival, double time) noexcept {
  log_.recordArrival(peer.place, arrival);
  const StatePacket& packet = arrival.packet;
  if (!isSane(packet) || packet.sender != peer.id) {
    ++log_.counters.packets_refused;
    log_.raise(kPacketRefused);
    return;
  }
  frame_.toWorld(arrival.packet);
  const bool is_of_now = packet.time >= peer.begun_at;
  bool is_latest = !peer.is_heard || (is_of_now && packet.sequence > peer.latest.sequence);
  if (is_latest) {
    peer.restart.noteNewest();
  } else if (peer.restart.isRestart(packet, peer.latest, time)) {
    beginAnew(peer, packet);
    is_latest = true;
  } else if (!is_of_now) {
    ++log_.counters.packets_stale;
    return;
  }
  if (is_latest) {
    peer.is_heard = true;
    peer.latest = packet;
    hear(peer, packet, time);
    hearEnergy(peer, packet);
  }
  const bool has_news = hearObjects(peer, packet, time) || is_latest;
  ++(has_news ? log_.counters.packets_taken : log_.counters.packets_stale);
}

/// The peer's program has restarted: nothing of its old packets counts any more.
void Peers::beginAnew(Peer& peer, const StatePacket& packet) noexcept {
  ++log_.counters.peers_restarted;
  peer.restart.noteNewest();
  peer.begun_at = packet.time;
  peer.rejoined_by = packet.sequence;
  peer.ledger.beginAnew();
  for (Tie& tie : peer.ties) {
    tie.sequence.reset();
    tie.awaited.reset();
    tie.epoch = {};
    tie.heard_at = peer.packets_heard;
    island_.setCouplerShare(tie.coupler, 0.0);
  }
}

/// Applies a user state that is newer than all before.
void Peers::hear(Peer& peer, const StatePacket& packet, double time) noexcept {
  if (!peer.link->hasLeft()) membership_.hear(peer.id, packet.roll, time);
  if (!peer.is_counted) return;
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

/// True if the first state of a peer's copy has it elsewhere. A site joined late, or began with
/// another world: nobody has stretched a spring between the copies.
bool Peers::isFoundElsewhere(const Tie& tie, const SharedObject& object,
                             const ObjectState& copy) const noexcept {
  if (tie.sequence) return false;
  return isTeleport(island_.state(object.body.index), copy.state, object.bounding_radius);
}

void Peers::noteJump(Peer& peer) noexcept {
  ++log_.counters.peer_jumps;
  peer.is_restrained = true;  // so that ticks lead its targets
}

/// An overtaken packet may still have the newest state of some object. True if it has one.
bool Peers::hearObjects(Peer& peer, const StatePacket& packet, double time) noexcept {
  bool has_news = false;
  ++peer.packets_heard;
  for (std::uint32_t i = 0; i < packet.object_count; ++i) {
    const ObjectState& copy = packet.objects[i];
    if (copy.id >= peer.ties.size()) continue;
    Tie& tie = peer.ties[copy.id];
    if (tie.sequence && packet.sequence <= *tie.sequence) continue;
    SharedObject& object = bodies_.objects[copy.id];
    const bool was_renewed = peer.isRenewed(tie, object) && !isFoundElsewhere(tie, object, copy);
    const bool is_reset = peer.is_counted && isNewer(copy.epoch, object.epoch);
    if (is_reset) adopt(object, copy, peer.place);
    tie.epoch = copy.epoch;
    tie.sequence = packet.sequence;
    tie.heard_at = peer.packets_heard;
    has_news = true;
    const bool jumped = tie.motion.isJump(copy.state.p_W, copy.state.v_W, packet.time, time,
                                          settings_.max_peer_speed);
    if (!peer.isRenewed(tie, object)) {
      if (was_renewed) island_.setCouplerShare(tie.coupler, 0.0);
    } else if (!was_renewed || is_reset) {
      tie.detour.start(island_.state(object.body.index), copy.state);
      island_.setCouplerShare(tie.coupler, tieShare(peer));
      peer.is_restrained = true;  // so that ticks lead its targets
    } else if (jumped) {
      noteJump(peer);
      tie.detour.start(tie.computeTarget(), copy.state);
    }
    peer.is_detouring |= !tie.detour.isOver();
    tie.theirs = limitMotion(copy.state, settings_.max_peer_speed);
    tie.velocity_share = 1.0;
    island_.setTarget(tie.coupler, tie.computeTarget());
  }
  letGoOfMissing(peer);
  return has_news;
}

/// An object that is missing in so many packets is one that the peer does not send.
std::size_t Peers::findPatience(const Peer& peer) const noexcept {
  const std::size_t count = peer.ties.size();
  return count > kMaxObjectsPerPacket ? kRoundsMissed * count : kPacketsMissed;
}

/// Lets go of objects that the peer no longer sends: it has none, or no state that can be sent. If
/// they do not fit into one packet, each waits for its turn. Looks at some of them per packet.
void Peers::letGoOfMissing(Peer& peer) noexcept {
  const std::size_t count = peer.ties.size();
  const std::size_t patience = findPatience(peer);
  for (std::size_t i = 0; i < std::min<std::size_t>(count, kMaxObjectsPerPacket); ++i) {
    peer.next_checked = (peer.next_checked + 1) % count;
    Tie& tie = peer.ties[peer.next_checked];
    const bool is_missing = peer.packets_heard - tie.heard_at >= patience;
    if (is_missing && tie.sequence && peer.isRenewed(tie, bodies_.objects[peer.next_checked]))
      awaitNews(peer, tie);
  }
}

void Peers::awaitNews(const SharedObject& object) noexcept {
  for (Peer& peer : peers_) awaitNews(peer, peer.ties[object.id]);
}

void Peers::awaitNews(const Peer& peer, Tie& tie) noexcept {
  tie.awaited = peer.is_heard ? peer.latest.sequence + 1 : 0;
  island_.setCouplerShare(tie.coupler, 0.0);
}

void Peers::send(Peer& peer, StatePacket& packet, double time) noexcept {
  const auto is_live = [](const Peer& other) { return other.health.state() == LinkState::kLive; };
  const auto sites = 1 + static_cast<int>(std::count_if(peers_.begin(), peers_.end(), is_live));
  // A peer that may be gone is granted nothing more; its report says so.
  packet.energy = energy_.report(peer.ledger, is_live(peer) ? sites : 1);
  peer.link->send(packet, time);
}

void Peers::shiftOrigin(const Vec3& offset_W) noexcept {
  frame_.shiftOrigin(offset_W);
  for (Peer& peer : peers_) {
    peer.latest.user.p_W += offset_W;
    for (ObjectState& copy : peer.latest.objects) copy.state.p_W += offset_W;
    peer.track.shiftOrigin(offset_W);
    peer.motion.shiftOrigin(offset_W);
    peer.searched_W += offset_W;
    for (Tie& tie : peer.ties) {
      tie.theirs.p_W += offset_W;
      tie.motion.shiftOrigin(offset_W);
    }
  }
}

void Peers::noteSearched() noexcept {
  for (Peer& peer : peers_)
    if (peer.user.body) peer.searched_W = island_.state(*peer.user.body).p_W;
}

}  // namespace tandem
