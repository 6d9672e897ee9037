#include "tandem/plugin/udp_mesh.h"

#include <array>
#include <chrono>

#include "tandem/plugin/udp_socket.h"

#include "net/peer_group.h"

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

/// The only use of the wall clock. A wrong one costs nothing but speed while under attack.
double readUtc() noexcept {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::vector<net::PeerGroup::Peer> toMeshPeers(std::vector<UdpPeer> peers) {
  std::vector<net::PeerGroup::Peer> all;
  for (UdpPeer& peer : peers) all.push_back({peer.id, peer.address, std::move(peer.key)});
  return all;
}

}  // namespace

struct UdpMesh::Impl {
  Impl(const UdpMeshSettings& settings, std::vector<UdpPeer> peers)
      : socket(settings.bind),
        mesh(settings.self, toMeshPeers(std::move(peers)),
             {settings.configuration, settings.playout, settings.profile,
              net::drawFirstNonce(readUtc())},
             socket) {}

  net::UdpSocket socket;
  net::PeerGroup mesh;
};

UdpMesh::UdpMesh(const UdpMeshSettings& settings, std::vector<UdpPeer> peers)
    : impl_(std::make_unique<Impl>(settings, std::move(peers))) {}

UdpMesh::~UdpMesh() = default;

Link& UdpMesh::link(PeerId peer) { return impl_->mesh.link(peer); }

void UdpMesh::poll(double now) noexcept {
  // One byte more than the longest datagram reveals a longer one.
  std::array<std::uint8_t, kMaxDatagramSize + 1> room;
  for (int i = 0; i < kMostPerPoll; ++i) {
    const auto received = impl_->socket.receive({room.data(), room.size()});
    if (!received) break;
    impl_->mesh.receive({room.data(), received->size}, received->from, now);
  }
  impl_->mesh.advance(now);
}

void UdpMesh::wait(double seconds) const noexcept { impl_->socket.wait(seconds); }

void UdpMesh::leave(double now, ByeReason reason) noexcept { impl_->mesh.leave(reason, now); }

PeerStatus UdpMesh::status(PeerId peer, double now) const { return impl_->mesh.status(peer, now); }

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

Address UdpMesh::bound() const noexcept { return impl_->socket.bound(); }

}  // namespace tandem
