#include "relay/make_member.h"

#include <chrono>
#include <stdexcept>
#include <utility>

#include "net/handshake_nonces.h"
#include "net/system_address.h"

namespace tandem::relay {

std::unique_ptr<RelayMember> makeMember(RelayAccess& access, PeerId self, std::uint64_t first_nonce,
                                        net::Outlet& socket, bool is_watcher) {
  const auto room = makeRoomName(access.room);
  if (!room)
    throw std::invalid_argument("room " + access.room +
                                ": must be 1 to 32 letters, digits, '.', '_' or '-'");
  if (access.address.port == 0 || net::isAny(access.address))
    throw std::invalid_argument("relay " + toString(access.address) +
                                ": must have a host and a port, such as relay.example:7000");
  return std::make_unique<RelayMember>(access.address, std::move(access.key), *room, self,
                                       first_nonce, socket, is_watcher);
}

RelayConnection describeConnection(const RelayMember& member, double now) {
  RelayConnection connection{member.isIn(), member.silence(now), member.roundTrip(), {}};
  if (member.refused()) connection.refused = explain(*member.refused());
  return connection;
}

std::uint64_t drawNonceOfNow() noexcept {
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return net::drawFirstNonce(std::chrono::duration<double>(since_1970).count());
}

}  // namespace tandem::relay
