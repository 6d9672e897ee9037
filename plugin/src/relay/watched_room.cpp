#include "relay/watched_room.h"

namespace tandem::relay {
namespace {

/// True if a datagram of run `a` replaces one of run `b`. Of two runs that began alike, which no
/// honest site has, the first one stays.
bool isLater(const WatchRun& a, const WatchRun& b) noexcept { return a.begun > b.begun; }

bool areEqual(const WatchRun& a, const WatchRun& b) noexcept {
  return a.begun == b.begun && a.random == b.random;
}

}  // namespace

WatchedRoom::Result WatchedRoom::take(std::uint16_t member, ByteSpan datagram,
                                      double now) noexcept {
  const Result result = open(member, datagram, now);
  ++counts_[static_cast<std::size_t>(result)];
  return result;
}

WatchedRoom::Result WatchedRoom::open(std::uint16_t member, ByteSpan datagram,
                                      double now) noexcept {
  const auto header = decodeWatchHeader({datagram.data, datagram.size});
  if (!header) return Result::kForm;
  if (header->sender != member) return Result::kSender;
  Heard& heard = sites_[header->sender - std::size_t{1}];
  const bool is_first = heard.site.states == 0;
  const bool is_next = areEqual(header->run, heard.run) && header->sequence >= heard.next_sequence;
  if (!is_first && !is_next && !isLater(header->run, heard.run)) return Result::kOld;
  const auto payload = openWatch(key_, *header, datagram);
  if (!payload) return Result::kForged;
  const auto state = decodeState(*payload, PeerId{header->sender});
  if (!state) return Result::kGate;
  // A new run may have other objects.
  if (!is_next) heard.has.reset();
  heard.run = header->run;
  heard.next_sequence = header->sequence + 1;
  heard.site = {state->packet, now, state->config_hash, heard.site.states + 1};
  for (std::uint32_t i = 0; i < state->packet.object_count; ++i) {
    heard.objects[state->packet.objects[i].id] = state->packet.objects[i];
    heard.has.set(state->packet.objects[i].id);
  }
  return Result::kTaken;
}

const WatchedRoom::Heard* WatchedRoom::find(PeerId site) const noexcept {
  const auto id = static_cast<std::uint32_t>(site);
  if (id < 1 || id > kMostMembers) return nullptr;
  const Heard& heard = sites_[id - 1];
  return heard.site.states > 0 ? &heard : nullptr;
}

const WatchedSite* WatchedRoom::site(PeerId id) const noexcept {
  const Heard* heard = find(id);
  return heard ? &heard->site : nullptr;
}

const ObjectState* WatchedRoom::object(PeerId site, ObjectId id) const noexcept {
  const Heard* heard = find(site);
  return heard && id < kMaxSharedObjects && heard->has.test(id) ? &heard->objects[id] : nullptr;
}

}  // namespace tandem::relay
