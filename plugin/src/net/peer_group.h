#pragma once

#include <memory>
#include <vector>

#include "tandem/coordination/link.h"

#include "net/peer_session.h"
#include "secure/cookie.h"

namespace tandem::net {

/// All pairs of one site over one socket. Finds the pair of a datagram, and answers strangers
/// without keeping state. The caller passes time and bytes. One thread.
class PeerGroup {
 public:
  struct Peer {
    PeerId id{};
    std::optional<Address> address;  ///< empty: the peer calls us
    SecretKey key;
    bool is_relayed = false;  ///< there is a relay, at makeRelayedAddress(id)
  };

  /// Throws std::invalid_argument for an id outside 1 to kMaxPeerId, a repeated id or our own.
  /// Throws it also for a configuration that is too long to send. `outlet` must outlive the mesh.
  PeerGroup(PeerId self, std::vector<Peer> peers, const PeerSession::Common& common,
            Outlet& outlet);
  ~PeerGroup();
  PeerGroup(const PeerGroup&) = delete;
  PeerGroup& operator=(const PeerGroup&) = delete;

  /// Processes a received datagram; may change its bytes. Checks everything and never throws.
  void receive(ByteSpan datagram, const Address& from, double now) noexcept;
  /// Sends what is due.
  void advance(double now) noexcept;
  void leave(ByeReason reason, double now) noexcept;
  /// Somebody who is trusted with nothing else tells that the peer may be there.
  void hearOf(PeerId peer, const Address& address) noexcept;

  /// Link to a peer, for a Site; lives as long as the mesh. Throws std::invalid_argument for an
  /// unknown id.
  [[nodiscard]] Link& link(PeerId peer);
  [[nodiscard]] PeerStatus status(PeerId peer, double now) const;
  [[nodiscard]] const DatagramCounts& counts() const noexcept { return counts_; }

 private:
  class PeerLink;
  /// Rate limits. Peers' addresses and all others have separate ones, so strangers cannot use up
  /// those of peers.
  struct Limits {
    RateLimit hellos, opens;
  };

  [[nodiscard]] Outcome handle(ByteSpan datagram, const Address& from, double now) noexcept;
  [[nodiscard]] Outcome handleHello(ByteView datagram, const Address& from, double now) noexcept;
  [[nodiscard]] bool takeHello(PeerSession& session, std::uint64_t nonce, const Address& from,
                               double now) noexcept;
  [[nodiscard]] Outcome handleOpen(ByteView datagram, const Address& from, double now) noexcept;
  [[nodiscard]] bool takeOpen(const PeerSession& session, const OpenMessage& open,
                              const Address& from, double now) noexcept;
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
  RateLimit old_hellos_;
  RateLimit refusals_;
  DatagramCounts counts_;
};

}  // namespace tandem::net
