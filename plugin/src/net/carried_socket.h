#pragma once

#include "tandem/plugin/datagram_carrier.h"
#include "tandem/plugin/udp_socket.h"

namespace tandem::net {

/// The address that means "this peer, by the carrier". Like that of a relayed peer it lies in the
/// discard-only prefix of RFC 6666; its scope differs.
[[nodiscard]] Address makeCarriedAddress(PeerId peer) noexcept;

/// A carrier in place of a socket: the peers' ids become addresses.
class CarriedSocket final : public Socket {
 public:
  /// `carrier` must outlive this.
  explicit CarriedSocket(DatagramCarrier& carrier) noexcept : carrier_(carrier) {}

  void send(ByteView datagram, const Address& to) noexcept override;
  [[nodiscard]] std::optional<Received> receive(ByteSpan room) noexcept override;
  void wait(double seconds) const noexcept override { carrier_.wait(seconds); }
  /// No address: all zero.
  [[nodiscard]] Address bound() const noexcept override { return {}; }

 private:
  DatagramCarrier& carrier_;
};

}  // namespace tandem::net
