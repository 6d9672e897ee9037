#include "tandem/plugin/watcher.h"

#include <array>
#include <stdexcept>
#include <utility>

#include <sodium.h>

#include "tandem/plugin/udp_socket.h"

#include "relay/make_member.h"
#include "relay/watched_room.h"

namespace tandem {
namespace {

constexpr int kMostPerPoll = 128;

/// Scenarios have at most 16 sites, so spectators take the ids above.
constexpr std::uint32_t kFirstId = 17;

PeerId drawId() noexcept {
  return PeerId{kFirstId + randombytes_uniform(relay::kMostMembers - kFirstId + 1)};
}

SecretKey takeWatchKey(RelayAccess& access) {
  if (!access.watch_key)
    throw std::invalid_argument("a spectator needs the watch key that the room's sites have");
  return std::move(*access.watch_key);
}

/// In the order of WatchedRoom::Result; docs/relay.md explains them.
constexpr std::array<const char*, relay::WatchedRoom::kResults> kNames = {
    "taken", "form", "sender", "old", "forged", "gate"};

}  // namespace

struct Watcher::Impl {
  Impl(RelayAccess access, const Address& bind)
      : socket(bind),
        room(takeWatchKey(access)),
        member(relay::makeMember(access, drawId(), relay::drawNonceOfNow(), socket, true)) {}
  ~Impl() { member->leave(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  net::UdpSocket socket;
  relay::WatchedRoom room;
  std::unique_ptr<relay::RelayMember> member;
};

Watcher::Watcher(RelayAccess access, const Address& bind)
    : impl_(std::make_unique<Impl>(std::move(access), bind)) {}

Watcher::~Watcher() = default;

void Watcher::poll(double now) noexcept {
  // One byte more than the longest datagram reveals a longer one.
  std::array<std::uint8_t, relay::kMaxForward + 1> bytes;
  for (int i = 0; i < kMostPerPoll; ++i) {
    const auto received = impl_->socket.receive({bytes.data(), bytes.size()});
    if (!received) break;
    if (received->from != impl_->member->relay()) continue;
    if (const auto said = impl_->member->receive({bytes.data(), received->size}, now))
      impl_->room.take(said->from, said->inner, now);
  }
  if (impl_->member->isIdTaken()) impl_->member->callAs(drawId());
  impl_->member->advance(now);
}

void Watcher::wait(double seconds) const noexcept { impl_->socket.wait(seconds); }

const WatchedSite* Watcher::latest(PeerId site) const noexcept { return impl_->room.site(site); }

const ObjectState* Watcher::object(PeerId site, ObjectId id) const noexcept {
  return impl_->room.object(site, id);
}

std::vector<PeerId> Watcher::heard() const {
  std::vector<PeerId> ids;
  for (std::uint32_t id = 1; id <= relay::kMostMembers; ++id)
    if (latest(PeerId{id})) ids.push_back(PeerId{id});
  return ids;
}

RelayConnection Watcher::relay(double now) const {
  return relay::describeConnection(*impl_->member, now);
}

std::vector<RefusedDatagrams> Watcher::refused() const {
  std::vector<RefusedDatagrams> all;
  for (std::size_t i = 0; i < relay::WatchedRoom::kResults; ++i) {
    const auto result = static_cast<relay::WatchedRoom::Result>(i);
    if (result != relay::WatchedRoom::Result::kTaken && impl_->room.count(result) > 0)
      all.push_back({kNames[i], impl_->room.count(result)});
  }
  return all;
}

Address Watcher::bound() const noexcept { return impl_->socket.bound(); }

}  // namespace tandem
