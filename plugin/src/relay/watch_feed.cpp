#include "relay/watch_feed.h"

#include <algorithm>

#include "net/relayed_address.h"
#include "relay/relay_wire.h"

namespace tandem::relay {
namespace {

/// Periods count in whole ticks, whose times round.
constexpr double kRounding = 1e-6;  // [s]

}  // namespace

WatchFeed::WatchFeed(const SecretKey& watch_key, PeerId self, const WatchRun& run,
                     WireProfile profile, std::uint32_t config_hash, net::Outlet& outlet)
    : header_{static_cast<std::uint16_t>(self), run, 0},
      sealer_(makeRunKey(watch_key, header_.sender, run), 0),
      profile_(profile),
      config_hash_(config_hash),
      outlet_(outlet) {}

void WatchFeed::take(const StatePacket& packet, double now) noexcept {
  note(packet);
  if (next_ && now < *next_ - kRounding) return;
  // After a pause the periods begin anew: what was not said is not made up for.
  next_ = next_ && now < *next_ + kPeriod ? *next_ + kPeriod : now + kPeriod;
  send(now);
}

void WatchFeed::note(const StatePacket& packet) noexcept {
  for (std::uint32_t i = 0; i < packet.object_count; ++i) {
    const ObjectState& object = packet.objects[i];
    if (object.id >= kMaxSharedObjects) continue;
    objects_[object.id] = object;
    has_news_.set(object.id);
  }
  newest_ = packet;
}

/// Objects with news take turns, so that none waits for ever.
void WatchFeed::pickObjects() noexcept {
  newest_.object_count = 0;
  for (std::size_t i = 0; i < kMaxSharedObjects && newest_.object_count < kMaxObjectsPerPacket;
       ++i) {
    const std::size_t id = (turn_ + i) % kMaxSharedObjects;
    if (!has_news_.test(id)) continue;
    has_news_.reset(id);
    newest_.objects[newest_.object_count++] = objects_[id];
  }
  if (newest_.object_count > 0)
    turn_ = newest_.objects[newest_.object_count - 1].id + std::size_t{1};
}

void WatchFeed::send(double now) noexcept {
  pickObjects();
  StateMessage message;
  message.packet = newest_;
  message.packet.energy.reset();  // the ledger is a matter between two sites
  message.flags |= flagRecords(message.packet);
  if (message.packet.is_idle) message.flags |= kStateIdle;
  message.send_time_us = toMicroseconds(now);
  message.profile = profile_;
  message.config_hash = config_hash_;
  std::array<std::uint8_t, kMaxWatch> room;
  const std::size_t size = encodeState(message, {room.data() + kWatchHeader, kMaxStateSize});
  if (size == 0) return;
  header_.sequence = sealer_.nextSequence();
  encodeWatchHeader(header_, {room.data(), kWatchHeader});
  if (!sealer_.seal({room.data(), kWatchHeader}, {room.data() + kWatchHeader, size + kWatchTag}))
    return;
  outlet_.send({room.data(), kWatchHeader + size + kWatchTag},
               net::makeRelayedAddress(PeerId{kAllWatchers}));
}

}  // namespace tandem::relay
