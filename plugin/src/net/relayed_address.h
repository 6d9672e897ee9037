#pragma once

#include <optional>

#include "tandem/coordination/types.h"
#include "tandem/plugin/address.h"

namespace tandem::net {

/// The address that means "through the relay, to this peer". It lies in the discard-only prefix of
/// RFC 6666 and has a scope that no socket reports, so it is the source of no datagram.
[[nodiscard]] inline Address makeRelayedAddress(PeerId peer) noexcept {
  Address address;
  address.ip[0] = 1;  // 100::/64
  address.port = static_cast<std::uint16_t>(peer);
  address.scope = ~std::uint32_t{0};
  return address;
}

/// The peer behind such an address; empty for any other.
[[nodiscard]] inline std::optional<PeerId> relayedPeer(const Address& address) noexcept {
  const PeerId peer{address.port};
  return address == makeRelayedAddress(peer) ? std::optional(peer) : std::nullopt;
}

}  // namespace tandem::net
