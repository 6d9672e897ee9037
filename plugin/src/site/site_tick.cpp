#include <algorithm>
#include <cmath>
#include <limits>

#include "site/site_impl.h"

namespace tandem {
namespace {

/// Moments closer than this are one moment [s]: far below a tick, far above rounding of a day of
/// seconds.
constexpr double kSameTime = 1e-10;

/// Slower bodies do not move [m/s]; a free island has the same limit.
constexpr double kStill = 1e-9;

/// Without motion for so long, a site is idle [s].
constexpr double kIdleAfter = 0.5;
/// States that say so at the full rate, before they become rare: some may be lost.
constexpr int kIdleNotices = 5;

/// Of ticks that were left out, so much is moved over [s].
constexpr double kMostMadeUp = 0.05;

/// A live host is expected to ask for nothing that is longer ago than this, besides its stalls [s],
/// and to step no faster than this [Hz].
constexpr double kLongestHorizon = 0.25, kFastestHost = 240.0;
constexpr double kMostMoments = 2048.0;

constexpr double kNever = std::numeric_limits<double>::infinity();

bool isSame(const RigidState& a, const RigidState& b) noexcept {
  return a.p_W == b.p_W && a.v_W == b.v_W && a.w_W == b.w_W && a.q_WB.coeffs() == b.q_WB.coeffs();
}

}  // namespace

std::uint32_t Site::Impl::tick(double now) noexcept {
  if (ticks == 0) {
    start_time = island_time = host_force_settled = now;
    // Steps that the host made before are not of this time, but for the one that may be under way.
    const double shift = now - std::max(0.0, host_time - host_step);
    handoff_due += shift;
    host_time += shift;
  }
  status_now = (status_ever | status_of_host) & kForGood;
  sample = device.read(now);
  makeUp(now);
  tick_start = now;
  placeHand();
  countHandWork();
  takeInUntil(now, now);
  followLinks(now);
  computeForce();
  capture(now);
  addToHash(now);
  device.write(force_W);
  lookForIdleness(now);
  advance(now, now + period());
  ++ticks;
  status_ever |= status_now;
  return status_now;
}

/// From now on a thread of its own ticks.
void Site::Impl::beginLive() {
  updateSurroundings(expectedHostStep());
  forEachBody([](SiteBody& body) { body.seen = body.bullet->state(); });
  // A live host's steps come as they like: room for all that it may ask for, made now.
  const double moments = (kLongestHorizon + settings.host_stall) * kFastestHost;
  snapshots.makeRoom(static_cast<std::size_t>(std::min(moments, kMostMoments)));
}

/// Ticks that the caller has left out: the island moves on over them, and does what was due, but
/// nothing is felt. The hand goes steadily to where it is now.
void Site::Impl::makeUp(double now) noexcept {
  if (now - island_time <= kSameTime || !isHandoff() || hasStopped()) return;
  const double most = makes_up ? kMostMadeUp : 0.0;
  if (now - island_time > most + kSameTime) loseTime(now - most);
  if (now - island_time > kSameTime && sample.valid && isFinite(sample.hip)) {
    RigidState hand = island.state(hip);
    hand.v_W = (sample.hip.p_W - hand.p_W) / (now - island_time);
    island.setState(hip, hand);
  }
  while (now - island_time > kSameTime) {
    tick_start = island_time;
    takeInUntil(tick_start, tick_start);
    followLinks(tick_start);
    advance(tick_start, std::min(island_time + period(), now));
    ++counters.ticks_made_up;
  }
}

/// Time that nobody has had: nothing moves, nothing is sent, and no host's step ends in it.
void Site::Impl::loseTime(double until) noexcept {
  settleHostForces();
  island_time = host_force_settled = until;
  const double packets = std::ceil((until - start_time) * settings.packet_rate);
  packets_due = std::max(packets_due, static_cast<std::uint64_t>(packets));
  if (host_step > 0.0 && handoff_due < until)
    handoff_due += std::ceil((until - handoff_due) / host_step) * host_step;
}

void Site::Impl::placeHand() noexcept {
  RigidState state = island.state(hip);
  if (!sample.valid || !isFinite(sample.hip)) {
    status_now |= kDeviceInvalid;
    // Where the hand went nobody knows: what stands for it stays, and pushes no further.
    state.v_W.setZero();
    island.setState(hip, state);
    return;
  }
  state.p_W = sample.hip.p_W;
  state.v_W = sample.hip.v_W;
  island.setState(hip, state);
}

void Site::Impl::computeForce() noexcept {
  if (native) {
    contact_W = native->handForce();
  } else if (!force_rest.holds(island)) {
    contact_W = island.computeContactForce(hip);
    force_rest.set(island);
  }
  const bool fault = lets_go || status_now & (kDeviceInvalid | kForGood);
  force_W = guard.follow(limitEnergy(guard.clamp(contact_W)), fault);
  counters.force_clamped = guard.clampedCount();
  counters.force_slewed = guard.slewedCount();
}

void Site::Impl::advance(double now, double end) noexcept {
  if (!start_rest.holds(island)) {
    // Who fell asleep in the last tick has moved in it, too.
    const std::vector<BodyIndex>& awake = island.awakeBodies();
    for (const BodyIndex b : moved_last) tick_start_states[b] = island.state(b);
    for (const BodyIndex b : awake) tick_start_states[b] = island.state(b);
    moved_last.assign(awake.begin(), awake.end());
    start_rest.set(island);
  }
  if (hasStopped()) return;

  if (!isHandoff()) {
    // Bullet moves the bodies: with impulses under the forces of the period's start.
    if (!native)
      forEachBody([&](SiteBody& body) { island.computeWrench(body.index, body.f_W, body.t_W); });
    sendIfDue(now);
    island_time = end;
    return;
  }
  // Events inside the period split it: packets, host steps that end, the end of the host's own
  // force, sends.
  for (;;) {
    const double due = start_time + static_cast<double>(packets_due) / settings.packet_rate;
    const double event =
        std::min({nextArrival(now, end), handoff_due,
                  host_force_end > island_time + kSameTime ? host_force_end : kNever, due});
    if (event >= end - kSameTime) break;
    advanceIsland(event);
    takeInUntil(event, now);
    sendIfDue(event);
  }
  advanceIsland(end);
  countWorldWork();
}

void Site::Impl::advanceIsland(double until) noexcept {
  if (until - island_time > kSameTime) {
    island.advance(std::min(until - island_time, period()));
    island_time = until;
  }
  if (has_host_forces && island_time >= host_force_end - kSameTime) endHostForces();
  if (handoff_due <= island_time + kSameTime) {
    keepStates(handoff_due);
    handoff_due = host_step > 0.0 ? handoff_due + host_step : kNever;
  }
}

void Site::Impl::endHostForces() noexcept {
  has_host_forces = false;
  settleHostForces();
  forEachBody([&](SiteBody& body) {
    body.f_host_W = body.t_host_W = Vec3::Zero();
    setWorldWrench(body.index, body.f_gravity_W, Vec3::Zero());
  });
}

/// For the host's step that ends at `time`.
void Site::Impl::keepStates(double time) noexcept {
  const auto copy = [&](std::vector<RigidState>& states) {
    for (std::size_t b = 0; b < states.size(); ++b)
      states[b] = island.state(static_cast<BodyIndex>(b));
  };
  if (!island.isAsleep()) return copy(snapshots.add(time));
  if (!snapshot_rest.holds(island)) {
    copy(snapshots.startRest());
    snapshot_rest.set(island);
  }
  snapshots.addRest(time);
}

double Site::Impl::nextArrival(double now, double until) noexcept {
  double earliest = kNever;
  for (Remote& remote : remotes) {
    if (!remote.pending) remote.pending = remote.link->receive(now, until);
    if (remote.pending) earliest = std::min(earliest, std::max(remote.pending->time, now));
  }
  return earliest;
}

void Site::Impl::takeInUntil(double time, double now) noexcept {
  while (nextArrival(now, std::nextafter(time, kNever)) <= time) {
    for (Remote& remote : remotes) {
      if (!remote.pending || remote.pending->time > time) continue;
      takeIn(remote, *remote.pending, std::max(remote.pending->time, now));
      remote.pending.reset();
    }
  }
}

void Site::Impl::takeIn(Remote& remote, const Arrival& arrival, double time) noexcept {
  const StatePacket& packet = arrival.packet;
  if (recording) recording->addArrival({static_cast<int>(&remote - remotes.data()), arrival});
  if (!isSane(packet) || packet.sender != remote.id) {
    ++counters.packets_refused;
    status_now |= kPacketRefused;
    return;
  }
  const bool is_latest = !remote.heard || packet.sequence > remote.latest.sequence;
  if (is_latest) {
    remote.heard = true;
    remote.latest = packet;
    hearRemote(remote, packet, time);
    hearEnergy(remote, packet);
  }
  const bool has_news = takeInObjects(remote, packet) || is_latest;
  ++(has_news ? counters.packets_taken : counters.packets_stale);
}

/// A packet that was overtaken may still have the newest there is of some object.
bool Site::Impl::takeInObjects(Remote& remote, const StatePacket& packet) noexcept {
  const auto place = static_cast<std::size_t>(&remote - remotes.data());
  bool has_news = false;
  for (std::uint32_t i = 0; i < packet.object_count; ++i) {
    const ObjectState& copy = packet.objects[i];
    if (copy.id >= objects.size()) continue;
    SharedObject& object = objects[copy.id];
    std::optional<std::uint64_t>& newest = remote.object_sequences[copy.id];
    if (newest && packet.sequence <= *newest) continue;
    const bool was_renewed = isRenewed(remote, object);
    newest = packet.sequence;
    has_news = true;
    Detour& detour = object.detours[place];
    if (!was_renewed && isRenewed(remote, object)) {
      detour.start(island.state(object.body.index), copy.state);
      remote.is_detouring |= !detour.isOver();
    }
    object.theirs[place] = copy.state;
    island.setTarget(object.couplers[place], detour.apply(copy.state));
  }
  return has_news;
}

/// A guided island never sleeps: its maps cost the same whatever moves.
bool Site::Impl::isStill() const noexcept {
  if (!settings.guide) return island.isAsleep();
  for (BodyIndex b = 0; b < island.bodyCount(); ++b)
    if (island.state(b).v_W.squaredNorm() > kStill * kStill) return false;
  return true;
}

void Site::Impl::lookForIdleness(double now) noexcept {
  const bool rests = contact_W == Vec3::Zero() && isStill();
  if (!rests || ticks == 0) busy_until = now;
  const bool was_idle = is_idle;
  is_idle = settings.thins_when_idle && now - busy_until >= kIdleAfter - kSameTime;
  if (!is_idle) idle_notices = kIdleNotices;
  if (was_idle && !is_idle) send(now);
}

void Site::Impl::sendIfDue(double until) noexcept {
  const auto stride = std::max<std::uint64_t>(
      static_cast<std::uint64_t>(settings.packet_rate * kIdlePacketPeriod), 1);
  for (;;) {
    const double due = start_time + static_cast<double>(packets_due) / settings.packet_rate;
    if (due > until + kSameTime) return;
    const bool is_rare = is_idle && idle_notices == 0;
    if (!is_rare || packets_due % stride == 0) send(isHandoff() ? due : until);
    if (is_idle && idle_notices > 0) --idle_notices;
    ++packets_due;
  }
}

void Site::Impl::send(double time) noexcept {
  StatePacket packet;
  packet.sender = settings.self;
  packet.sequence = counters.packets_sent;
  packet.is_idle = is_idle;
  if (keepsAccount()) packet.port_energy = passivity.own();
  packet.time = time;
  packet.user = island.state(hip).point();
  if (time > tick_start && device.capabilities().is_continuous) {
    const DeviceSample between = device.read(time);
    if (between.valid && isFinite(between.hip)) packet.user = between.hip;
  }
  const auto has_moved = [&](std::size_t i) {
    return !isSame(objects[i].sent, island.state(objects[i].body.index));
  };
  for (const std::size_t i : packet_turns.choose(has_moved)) {
    objects[i].sent = island.state(objects[i].body.index);
    packet.objects[packet.object_count++] = {objects[i].id, objects[i].sent};
  }
  for (Remote& remote : remotes) remote.link->send(packet, time);
  ++counters.packets_sent;
}

void Site::Impl::capture(double now) noexcept {
  if (!recording) return;
  const auto fill = [&](const SiteBody& body, BodyRecord& record) {
    record.island = island.state(body.index);
    record.bullet = desk.isOpen() || !body.bullet ? body.seen : body.bullet->state();
  };
  for (std::size_t i = 0; i < objects.size(); ++i) fill(objects[i].body, object_records[i]);
  for (std::size_t i = 0; i < remotes.size(); ++i) {
    const Remote& remote = remotes[i];
    if (remote.proxy) fill(remote.body, proxy_records[i]);
    if (remote.held_proxy)
      proxy_records[i] = {island.state(*remote.user.body), remote.held_proxy->state()};
  }
  recording->addTick({now, sample, force_W, contact_W != Vec3::Zero()}, object_records.data(),
                     proxy_records.data());
}

void Site::Impl::addToHash(double now) noexcept {
  hash.add(now);
  hash.add(force_W);
  if (hash_rest.holds(island)) return;
  hash_rest.set(island);
  bool finite = true;
  for (const BodyIndex b : island.awakeBodies()) {
    hash.add(island.state(b));
    finite &= isFinite(island.state(b));
  }
  if (!finite) status_now |= kStateNotFinite;
}

}  // namespace tandem
