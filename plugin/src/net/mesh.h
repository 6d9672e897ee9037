#pragma once

#include <memory>
#include <vector>

#include "tandem/coordination/link.h"

#include "net/peer_session.h"
#include "secure/cookie.h"

namespace tandem::net {

/// All pairs of one site over one socket: finds whom a datagram is for, and answers strangers
/// without keeping anything of them. Time and bytes are passed in. One thread.
class Mesh {
 public:
  struct Peer {
    PeerId id{};
    std::optional<Address> address;  ///< nothing: it is to call us
    SecretKey key;
  };

  /// Throws std::invalid_argument for ids outside 1 to 8, twice or our own, and for a configuration
  /// that cannot be sent. `outlet` must outlive the mesh.
  Mesh(PeerId self, std::vector<Peer> peers, const PeerSession::Common& common, Outlet& outlet);
  ~Mesh();
  Mesh(const Mesh&) = delete;
  Mesh& operator=(const Mesh&) = delete;

  /// A datagram that came in; its bytes may be changed. Never trusts it, never throws.
  void receive(ByteSpan datagram, const Address& from, double now) noexcept;
  /// Says what is due.
  void advance(double now) noexcept;
  void leave(ByeReason reason, double now) noexcept;

  /// The way to a peer, as a Site wants it. It lives as long as the mesh. Throws
  /// std::invalid_argument for an id that is no peer.
  [[nodiscard]] Link& link(PeerId peer);
  [[nodiscard]] PeerStatus status(PeerId peer, double now) const;
  [[nodiscard]] const DatagramCounts& counts() const noexcept { return counts_; }

 private:
  class PeerLink;
  /// From the addresses of peers, and from all others: strangers use up only their own.
  struct Limits {
    RateLimit hellos, opens;
  };

  [[nodiscard]] Outcome handle(ByteSpan datagram, const Address& from, double now) noexcept;
  [[nodiscard]] Outcome handleHello(ByteView datagram, const Address& from, double now) noexcept;
  [[nodiscard]] Outcome handleOpen(ByteView datagram, const Address& from, double now) noexcept;
  [[nodiscard]] Outcome handleSealed(const ClearHeader& header, ByteSpan datagram,
                                     const Address& from, double now) noexcept;
  [[nodiscard]] Limits& limitsOf(const PeerSession& session, const Address& from) noexcept;
  [[nodiscard]] PeerSession* find(PeerId peer) noexcept;
  void refuse(const HandshakeRoute& asked, RefuseCode code, const Address& to, double now) noexcept;

  PeerId self_;
  Outlet& outlet_;
  std::vector<std::unique_ptr<PeerSession>> sessions_;
  std::vector<std::unique_ptr<PeerLink>> links_;
  secure::CookieMaker cookies_;
  Limits known_, strange_;
  RateLimit refusals_;
  DatagramCounts counts_;
};

}  // namespace tandem::net
