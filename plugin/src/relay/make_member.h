#pragma once

#include <memory>

#include "tandem/plugin/udp_mesh.h"

#include "relay/relay_member.h"

namespace tandem::relay {

/// A member of the room that `access` names; takes its key. `first_nonce` and `socket` as for
/// RelayMember. Throws std::invalid_argument, in one line, for a room or an address that cannot be.
[[nodiscard]] std::unique_ptr<RelayMember> makeMember(RelayAccess& access, PeerId self,
                                                      std::uint64_t first_nonce,
                                                      net::Outlet& socket, bool is_watcher = false);

/// The state of a member's connection, for a user. Allocates.
[[nodiscard]] RelayConnection describeConnection(const RelayMember& member, double now);

/// drawFirstNonce() of now. The only use of the wall clock: a wrong one costs speed while under
/// attack, and spectators of a site whose clock was set back begin anew.
[[nodiscard]] std::uint64_t drawNonceOfNow() noexcept;

}  // namespace tandem::relay
