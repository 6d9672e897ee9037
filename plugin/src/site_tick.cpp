#include <algorithm>
#include <cmath>
#include <limits>

#include "site_impl.h"

namespace tandem {
namespace {

/// Moments closer than this are one moment [s]: far below a tick, far above rounding of a day of
/// seconds.
constexpr double kSameTime = 1e-10;

constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace

std::uint32_t Site::Impl::tick(double now) noexcept {
  if (ticks == 0) {
    start_time = island_time = host_force_settled = now;
    handoff_due += now;
    host_time += now;
  }
  status_now = status_ever & (kBodyMissing | kStateNotFinite);
  tick_start = now;
  readDevice(now);
  takeInUntil(now, now);
  computeForce();
  capture(now);
  addToHash(now);
  device.write(force_W);
  advance(now);
  ++ticks;
  status_ever |= status_now;
  return status_now;
}

void Site::Impl::readDevice(double now) noexcept {
  sample = device.read(now);
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
  contact_W = island.computeContactForce(hip);
  const bool fault = status_now & (kDeviceInvalid | kBodyMissing | kStateNotFinite);
  force_W = guard.limit(contact_W, fault);
}

void Site::Impl::advance(double now) noexcept {
  const double end = now + period();
  for (std::size_t b = 0; b < tick_start_states.size(); ++b)
    tick_start_states[b] = island.state(static_cast<BodyIndex>(b));
  if (status_now & (kBodyMissing | kStateNotFinite)) return;

  if (!isHandoff()) {
    // Bullet moves the bodies over this period under the forces of its start.
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
}

void Site::Impl::advanceIsland(double until) noexcept {
  if (until - island_time > kSameTime) {
    island.advance(std::min(until - island_time, period()));
    island_time = until;
  }
  if (std::abs(island_time - host_force_end) <= kSameTime) {
    settleHostForces();
    forEachBody([&](SiteBody& body) {
      body.f_host_W = body.t_host_W = Vec3::Zero();
      island.setExternalWrench(body.index, body.f_gravity_W, Vec3::Zero());
    });
  }
  if (handoff_due <= island_time + kSameTime) {
    std::vector<RigidState>& states = snapshots.add(handoff_due);
    for (std::size_t b = 0; b < states.size(); ++b)
      states[b] = island.state(static_cast<BodyIndex>(b));
    handoff_due = host_step > 0.0 ? handoff_due + host_step : kNever;
  }
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
      takeIn(remote, *remote.pending);
      remote.pending.reset();
    }
  }
}

void Site::Impl::takeIn(Remote& remote, const Arrival& arrival) noexcept {
  const StatePacket& packet = arrival.packet;
  if (recording) recording->addArrival({static_cast<int>(&remote - remotes.data()), arrival});
  if (!isSane(packet) || packet.sender != remote.id) {
    ++counters.packets_refused;
    status_now |= kPacketRefused;
    return;
  }
  if (remote.heard && packet.sequence <= remote.latest.sequence) {
    ++counters.packets_stale;
    return;
  }
  ++counters.packets_taken;
  remote.heard = true;
  remote.latest = packet;
  scheme.follow(island, remote.user, packet.user);
  for (std::uint32_t i = 0; i < packet.object_count; ++i) {
    const ObjectState& copy = packet.objects[i];
    if (copy.id < objects.size())
      island.setTarget(objects[copy.id].couplers[&remote - remotes.data()], copy.state);
  }
}

void Site::Impl::sendIfDue(double until) noexcept {
  for (;;) {
    const double due = start_time + static_cast<double>(packets_due) / settings.packet_rate;
    if (due > until + kSameTime) return;
    send(isHandoff() ? due : until);
    ++packets_due;
  }
}

void Site::Impl::send(double time) noexcept {
  StatePacket packet;
  packet.sender = settings.self;
  packet.sequence = packets_due;
  packet.time = time;
  packet.user = island.state(hip).point();
  if (time > tick_start && device.capabilities().is_continuous) {
    const DeviceSample between = device.read(time);
    if (between.valid && isFinite(between.hip)) packet.user = between.hip;
  }
  packet.object_count = static_cast<std::uint32_t>(objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i)
    packet.objects[i] = {objects[i].id, island.state(objects[i].body.index)};
  for (Remote& remote : remotes) remote.link->send(packet, time);
  ++counters.packets_sent;
}

void Site::Impl::capture(double now) noexcept {
  if (!recording) return;
  const auto fill = [&](const SiteBody& body, BodyRecord& record) {
    record.island = island.state(body.index);
    record.bullet = body.bullet->state();
  };
  for (std::size_t i = 0; i < objects.size(); ++i) fill(objects[i].body, object_records[i]);
  for (std::size_t i = 0; i < remotes.size(); ++i)
    if (remotes[i].proxy) fill(remotes[i].body, proxy_records[i]);
  recording->addTick({now, sample, force_W, contact_W != Vec3::Zero()}, object_records.data(),
                     proxy_records.data());
}

void Site::Impl::addToHash(double now) noexcept {
  hash.add(now);
  hash.add(force_W);
  bool finite = true;
  for (BodyIndex b = 0; b < island.bodyCount(); ++b) {
    hash.add(island.state(b));
    finite &= isFinite(island.state(b));
  }
  if (!finite) status_now |= kStateNotFinite;
}

}  // namespace tandem
