#include "net/carried_socket.h"

#include <algorithm>

namespace tandem::net {

Address makeCarriedAddress(PeerId peer) noexcept {
  Address address;
  address.ip[0] = 1;  // 100::/64
  address.port = static_cast<std::uint16_t>(peer);
  address.scope = ~std::uint32_t{1};
  return address;
}

void CarriedSocket::send(ByteView datagram, const Address& to) noexcept {
  carrier_.send(datagram, PeerId{to.port});
}

/// A carrier that reports more bytes than there is room for cannot lead anybody beyond the room.
std::optional<Socket::Received> CarriedSocket::receive(ByteSpan room) noexcept {
  const auto received = carrier_.receive(room);
  if (!received) return std::nullopt;
  return Received{std::min(received->size, room.size), makeCarriedAddress(received->from)};
}

}  // namespace tandem::net
