#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tandem/plugin/datagram_carrier.h"
#include "tandem/plugin/udp_mesh.h"

#include "command/arguments.h"
#include "peer/changed_scenario.h"

namespace tandem::demos {

/// Which site this is, and how it reaches the others; as written on the command line.
struct PeerLine {
  int site = 0;
  std::string carrier = "udp";  ///< or dds, dds:DOMAIN; then there are no addresses
  std::string bind;
  std::vector<std::string> peers;  ///< addresses of other sites, as SiteValue says
  std::vector<std::string> keys;   ///< key files, shared with one other site or all
  std::string relay, relay_key;    ///< address and key file; empty: no relay
  std::string room = "tandem";     ///< of the relay
  std::string watch_key;           ///< key file of the spectators; empty: there are none
  double patience = 30.0;          ///< time to wait for the other sites [s]
  std::string playout = "on";
  std::string profile = "float32";

  [[nodiscard]] bool isByUdp() const { return carrier == "udp"; }
};

/// Declares --site, --bind, --peer, --key, --relay, --relay-key, --room, --watch-key, --wait,
/// --playout and --wire.
void declarePeerLine(Arguments& arguments, PeerLine& line);

/// Throws UsageError for a --wait that nobody means.
void checkPatience(const PeerLine& line);

/// Checks the line of a session of `count` sites. Throws UsageError that names the option and the
/// allowed values.
void checkPeerLine(const PeerLine& line, std::size_t count);

/// The carrier of `line` for a session of `count` sites; null: UDP. Throws UsageError for other
/// words, and as makeDdsCarrier() does.
[[nodiscard]] std::unique_ptr<DatagramCarrier> makeCarrier(const PeerLine& line, std::size_t count);

/// Settings of the socket. All sites must run the same scenario, changed alike. Throws as
/// resolveAddress() does.
[[nodiscard]] UdpMeshSettings makeMeshSettings(const PeerLine& line,
                                               const ChangedScenario& scenario);

/// The other ones of `count` sites, in the order of their numbers, each with the key that it shares
/// with this one. Says on stderr if a key may be swapped to disk. Throws as resolveAddress() and
/// readKeyFile() do.
[[nodiscard]] std::vector<UdpPeer> makeOtherSites(const PeerLine& line, std::size_t count);

/// Empty without a relay. Throws as makeOtherSites().
[[nodiscard]] std::optional<RelayAccess> makeRelayAccess(const PeerLine& line);

}  // namespace tandem::demos
