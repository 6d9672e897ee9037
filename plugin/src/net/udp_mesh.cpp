#include "tandem/plugin/udp_mesh.h"

#include <array>
#include <map>

#include "tandem/plugin/udp_socket.h"

#include "net/carried_socket.h"
#include "net/peer_group.h"
#include "net/random.h"
#include "net/relayed_address.h"
#include "relay/make_member.h"
#include "relay/watch_feed.h"

namespace tandem {
namespace {

/// Most datagrams per poll, 128,000 per second at 1 kHz: a flood must not delay the tick, and the
/// peer's datagrams must still fit.
constexpr int kMostPerPoll = 128;

const char* name(net::Refusal refusal) noexcept {
  switch (refusal) {
    case net::Refusal::kNone:
      return "none";
    case net::Refusal::kForm:
      return "form";
    case net::Refusal::kNotForMe:
      return "not_for_me";
    case net::Refusal::kOutOfTurn:
      return "out_of_turn";
    case net::Refusal::kTooMany:
      return "too_many";
    case net::Refusal::kCookie:
      return "cookie";
    case net::Refusal::kKey:
      return "key";
    case net::Refusal::kUnknownSession:
      return "unknown_session";
    case net::Refusal::kExpired:
      return "expired";
    case net::Refusal::kReplayed:
      return "replayed";
    case net::Refusal::kForged:
      return "forged";
    case net::Refusal::kNotAgreed:
      return "not_agreed";
    case net::Refusal::kAfterBye:
      return "after_bye";
  }
  return "";
}

std::unique_ptr<net::Socket> openSocket(const UdpMeshSettings& settings, bool has_relay) {
  if (!settings.carrier) return std::make_unique<net::UdpSocket>(settings.bind);
  if (has_relay)
    throw std::invalid_argument("a relay needs UDP; leave out the relay or the carrier");
  return std::make_unique<net::CarriedSocket>(*settings.carrier);
}

std::vector<net::PeerGroup::Peer> toMeshPeers(std::vector<UdpPeer> peers, bool are_relayed,
                                              bool are_carried) {
  std::vector<net::PeerGroup::Peer> all;
  for (UdpPeer& peer : peers) {
    if (are_carried) peer.address = net::makeCarriedAddress(peer.id);
    all.push_back({peer.id, peer.address, std::move(peer.key), are_relayed});
  }
  return all;
}

}  // namespace

struct UdpMesh::Impl {
  Impl(const UdpMeshSettings& settings, std::vector<UdpPeer> peers,
       std::optional<RelayAccess> access)
      : socket(openSocket(settings, access.has_value())),
        is_carried(settings.carrier != nullptr),
        member(access ? relay::makeMember(*access, settings.self, first_nonce, *socket) : nullptr),
        mesh(settings.self, toMeshPeers(std::move(peers), member != nullptr, is_carried),
             {settings.configuration, settings.playout, settings.profile, first_nonce}, outlet()) {
    if (!access || !access->watch_key) return;
    feed.emplace(*access->watch_key, settings.self,
                 relay::WatchRun{first_nonce, net::drawNumber<std::uint64_t>()}, settings.profile,
                 settings.watch_hash.value_or(hashConfiguration(settings.configuration)), *member);
  }
  ~Impl() {
    if (member) member->leave();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  [[nodiscard]] net::Outlet& outlet() noexcept {
    if (member) return *member;
    return *socket;
  }
  void receive(ByteSpan datagram, const Address& from, double now) noexcept;
  void advanceMember(double now) noexcept;

  const std::uint64_t first_nonce = relay::drawNonceOfNow();
  std::unique_ptr<net::Socket> socket;
  const bool is_carried;
  std::unique_ptr<relay::RelayMember> member;  ///< null without a relay
  net::PeerGroup mesh;
  std::optional<relay::WatchFeed> feed;        ///< empty without a watch key
  std::map<PeerId, relay::WatchedLink> links;  ///< of a site with spectators; else empty
};

/// A datagram of the relay has either one of a peer in it, or concerns the relay alone.
void UdpMesh::Impl::receive(ByteSpan datagram, const Address& from, double now) noexcept {
  if (!member || from != member->relay()) {
    mesh.receive(datagram, from, now);
    return;
  }
  if (const auto said = member->receive(datagram, now))
    mesh.receive(said->inner, net::makeRelayedAddress(PeerId{said->from}), now);
}

void UdpMesh::Impl::advanceMember(double now) noexcept {
  if (!member) return;
  member->advance(now);
  if (const auto seen = member->takeSeen()) mesh.hearOf(seen->member, seen->address);
}

UdpMesh::UdpMesh(const UdpMeshSettings& settings, std::vector<UdpPeer> peers,
                 std::optional<RelayAccess> relay)
    : impl_(std::make_unique<Impl>(settings, std::move(peers), std::move(relay))) {}

UdpMesh::~UdpMesh() = default;

Link& UdpMesh::link(PeerId peer) {
  Link& link = impl_->mesh.link(peer);
  if (!impl_->feed) return link;
  return impl_->links.try_emplace(peer, link, *impl_->feed).first->second;
}

void UdpMesh::poll(double now) noexcept {
  // One byte more than the longest datagram reveals a longer one.
  std::array<std::uint8_t, relay::kMaxForward + 1> room;
  for (int i = 0; i < kMostPerPoll; ++i) {
    const auto received = impl_->socket->receive({room.data(), room.size()});
    if (!received) break;
    impl_->receive({room.data(), received->size}, received->from, now);
  }
  impl_->advanceMember(now);
  impl_->mesh.advance(now);
}

void UdpMesh::wait(double seconds) const noexcept { impl_->socket->wait(seconds); }

void UdpMesh::leave(double now, ByeReason reason) noexcept { impl_->mesh.leave(reason, now); }

PeerStatus UdpMesh::status(PeerId peer, double now) const {
  PeerStatus status = impl_->mesh.status(peer, now);
  if (impl_->is_carried) status.address.reset();
  if (status.is_relayed && impl_->member) status.address = impl_->member->relay();
  return status;
}

std::optional<RelayConnection> UdpMesh::relay(double now) const {
  if (!impl_->member) return std::nullopt;
  return relay::describeConnection(*impl_->member, now);
}

std::uint64_t UdpMesh::received() const noexcept { return impl_->mesh.counts().received; }

std::vector<RefusedDatagrams> UdpMesh::refused() const {
  const net::DatagramCounts& counts = impl_->mesh.counts();
  std::vector<RefusedDatagrams> all;
  const auto add = [&](const std::string& reason, std::uint64_t count) {
    if (count > 0) all.push_back({reason, count});
  };
  for (std::size_t i = 0; i < counts.form.size(); ++i)
    add(std::string("form: ") + tandem::name(static_cast<WireRefusal>(i)), counts.form[i]);
  for (std::size_t i = 0; i < counts.refused.size(); ++i)
    if (static_cast<net::Refusal>(i) != net::Refusal::kForm)
      add(name(static_cast<net::Refusal>(i)), counts.refused[i]);
  return all;
}

Address UdpMesh::bound() const noexcept { return impl_->socket->bound(); }

}  // namespace tandem
