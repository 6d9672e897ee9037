#pragma once

#include <optional>
#include <string>

#include "tandem/plugin/udp_mesh.h"

#include "command/arguments.h"
#include "peer/changed_scenario.h"

namespace tandem::demos {

/// Which site this is, and how it reaches the other; as written on the command line.
struct PeerLine {
  int site = 0;
  std::string bind;
  std::string peer;  ///< empty: met through the relay
  std::string key;
  std::string relay, relay_key;  ///< address and key file; empty: no relay
  std::string room = "tandem";   ///< of the relay
  double patience = 30.0;        ///< time to wait for the other site [s]
  std::string playout = "on";
  std::string profile = "float32";
};

/// Declares --site, --bind, --peer, --key, --relay, --relay-key, --room, --wait, --playout and
/// --wire.
void declarePeerLine(Arguments& arguments, PeerLine& line, const OptionRules& rules);

/// Throws UsageError that names the option and the allowed values.
void checkPeerLine(const PeerLine& line);

/// Settings of the socket. Both sites must run the same scenario, changed alike. Throws as
/// resolveAddress() does.
[[nodiscard]] UdpMeshSettings makeMeshSettings(const PeerLine& line,
                                               const ChangedScenario& scenario);

/// The other site with the key that both share. Says on stderr if the key may be swapped to disk.
/// Throws as resolveAddress() and readKeyFile() do.
[[nodiscard]] UdpPeer makeOtherSite(const PeerLine& line);

/// Empty without a relay. Throws as makeOtherSite().
[[nodiscard]] std::optional<RelayAccess> makeRelayAccess(const PeerLine& line);

}  // namespace tandem::demos
