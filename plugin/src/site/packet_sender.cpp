#include "site/packet_sender.h"

#include <algorithm>
#include <cmath>

#include "coordination/src/wire/state_gate.h"
#include "site/idle_stride.h"

namespace tandem {
namespace {

/// Slower bodies count as still [m/s]; a free island uses the same limit.
constexpr double kStill = 1e-9;

/// A site without motion for this long is idle [s].
constexpr double kIdleAfter = 0.5;
/// Idle packets sent at the full rate before packets become rare: some may be lost.
constexpr int kIdleNotices = 5;

}  // namespace

PacketSender::PacketSender(const SiteSettings& settings, const Island& island,
                           const Timeline& timeline, const Bodies& bodies, LocalHand& hand,
                           Peers& peers, const Grips& grips, SiteLog& log) noexcept
    : settings_(settings),
      island_(island),
      timeline_(timeline),
      bodies_(bodies),
      hand_(hand),
      peers_(peers),
      grips_(grips),
      log_(log),
      idle_stride_(computeIdleStride(settings.packet_rate)),
      interest_(settings, island, bodies, peers) {}

void PacketSender::setSize(std::size_t objects, std::size_t peers) {
  interest_.setSize(objects, peers);
  due_.reserve(peers);
}

void PacketSender::sendIfDue(double until, bool is_exact) noexcept {
  for (;;) {
    const double moment = due();
    if (moment > until + kSameTime) return;
    const bool is_rare = is_idle_ && idle_notices_ == 0;
    if (!is_rare || packets_due_ % idle_stride_ == 0) send(is_exact ? moment : until, is_rare);
    if (is_idle_ && idle_notices_ > 0) --idle_notices_;
    ++packets_due_;
    // All others that are due would tell the same state.
    if (!is_exact) skipTo(until);
  }
}

void PacketSender::skipTo(double until) noexcept {
  const double packets = std::ceil((until - timeline_.start()) * settings_.packet_rate);
  packets_due_ = std::max(packets_due_, static_cast<std::uint64_t>(packets));
}

void PacketSender::lookForIdleness(double now) noexcept {
  const bool rests = hand_.contact() == Vec3::Zero() && isStill() && !grips_.isBusy();
  if (!rests || !timeline_.hasBegun()) busy_until_ = now;
  const bool was_idle = is_idle_;
  is_idle_ = settings_.thins_when_idle && now - busy_until_ >= kIdleAfter - kSameTime;
  if (!is_idle_) idle_notices_ = kIdleNotices;
  if (was_idle && !is_idle_) send(now, true);
}

/// A guided island never sleeps, because its maps cost the same whatever moves.
bool PacketSender::isStill() const noexcept {
  if (!settings_.guide) return island_.isAsleep();
  for (BodyIndex b = 0; b < island_.bodyCount(); ++b)
    if (island_.state(b).v_W.squaredNorm() > kStill * kStill) return false;
  return true;
}

/// A receiver would refuse the whole packet for one state that is out of range.
bool PacketSender::maySend(const RigidState& state) noexcept {
  if (wire::StateGate(WireLimits{}).check(state) == WireRefusal::kNone) return true;
  noteWithheld();
  return false;
}

/// The user, or where it was last in range.
PointState PacketSender::limitUser(const PointState& user) noexcept {
  if (wire::StateGate(WireLimits{}).check(user) == WireRefusal::kNone) return user;
  noteWithheld();
  return {sent_user_.p_W, Vec3::Zero()};
}

void PacketSender::noteWithheld() noexcept {
  log_.raise(kOutOfRange);
  ++log_.counters.states_withheld;
}

/// `to_all`: rare packets go to all peers.
void PacketSender::send(double time, bool to_all) noexcept {
  const PointState user_W = hand_.pointAt(time, timeline_.tickStart());
  StatePacket packet;
  packet.sender = settings_.self;
  packet.sequence = sequence_++;
  packet.time = time;
  packet.user = sent_user_ = limitUser(peers_.frame().toSession(user_W));
  packet.grip = grips_.state(time);
  packet.roll = peers_.tellRoll(time);
  peers_.sayEpochs();
  interest_.look(user_W, packet.grip, packets_due_, time);
  due_.clear();
  for (Peer& peer : peers_)
    if (to_all || interest_.isDue(peer)) due_.push_back(&peer);
  for (std::size_t i = 0; i < due_.size(); ++i) {
    packet.is_idle = is_idle_ || interest_.isFar(*due_[i]);
    addObjects(packet, interest_.choose(*due_[i], due_.size() - i, time));
    peers_.send(*due_[i], packet, time);
  }
  ++log_.counters.packets_sent;
}

void PacketSender::addObjects(StatePacket& packet,
                              const std::vector<std::size_t>& chosen) noexcept {
  packet.object_count = 0;
  for (const std::size_t i : chosen) {
    const SharedObject& object = bodies_.objects[i];
    const RigidState told = peers_.frame().toSession(island_.state(object.body.index));
    if (!object.is_sent || !maySend(told)) continue;
    packet.objects[packet.object_count++] = {object.id, told, object.said};
  }
}

}  // namespace tandem
