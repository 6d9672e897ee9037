#include "peer/peer_line.h"

#include <cstdio>
#include <utility>

#include <fmt/format.h>

#include "tandem/plugin/key_file.h"

#include "peer/peer_configuration.h"
#include "terminal/usage_error.h"

namespace tandem::demos {

void declarePeerLine(Arguments& arguments, PeerLine& line, const OptionRules& rules) {
  arguments.option("--site", line.site, "which site this is: 1 or 2", rules);
  arguments.option("--bind", line.bind, "own address, e.g. :7001", rules);
  arguments.option("--peer", line.peer, "the other site's address, e.g. host:7002");
  arguments.option("--key", line.key, "key file that both sites share", rules);
  arguments.option("--relay", line.relay, "a relay where both sites meet, e.g. host:7000");
  arguments.option("--relay-key", line.relay_key, "key file of the relay");
  arguments.option("--room", line.room, "room of the relay, the same for both sites");
  arguments.option("--wait", line.patience, "seconds to wait for the other site");
  arguments.option("--playout", line.playout,
                   "on: jitter becomes constant delay; off: states are applied as they come",
                   {.choices = {"on", "off"}});
  arguments.option("--wire", line.profile, "width of numbers on the way",
                   {.choices = {"float32", "float64"}});
}

void checkPeerLine(const PeerLine& line) {
  if (line.peer.empty() && line.relay.empty())
    throw UsageError("--peer is required, or --relay and --relay-key");
  if (line.relay.empty() != line.relay_key.empty())
    throw UsageError("--relay and --relay-key go together; give both or none");
  if (line.site != 1 && line.site != 2)
    throw UsageError(fmt::format("--site {}: must be 1 or 2", line.site));
  if (!(line.patience > 0.0 && line.patience <= 86400.0))
    throw UsageError("--wait: must be above 0 and at most 86400 s");
}

UdpMeshSettings makeMeshSettings(const PeerLine& line, const ChangedScenario& scenario) {
  UdpMeshSettings settings;
  settings.self = PeerId{static_cast<std::uint32_t>(line.site)};
  settings.bind = resolveAddress(line.bind);
  settings.profile = line.profile == "float64" ? WireProfile::kFloat64 : WireProfile::kFloat32;
  settings.playout.is_on = line.playout == "on";
  Configuration items = makePeerConfiguration(scenario.scenario);
  if (const auto change = describeChange(scenario)) items.push_back(*change);
  items.push_back({"wire.profile", line.profile});
  settings.configuration = makeConfiguration(std::move(items));
  return settings;
}

UdpPeer makeOtherSite(const PeerLine& line) {
  UdpPeer peer{PeerId{static_cast<std::uint32_t>(3 - line.site)}, std::nullopt,
               readKeyFile(line.key)};
  if (!line.peer.empty()) peer.address = resolveAddress(line.peer);
  if (!peer.key.isLocked())
    fmt::print(stderr, "tandem: note: the key may be swapped to disk; raise ulimit -l\n");
  return peer;
}

std::optional<RelayAccess> makeRelayAccess(const PeerLine& line) {
  if (line.relay.empty()) return std::nullopt;
  return RelayAccess{resolveAddress(line.relay), readKeyFile(line.relay_key), line.room};
}

}  // namespace tandem::demos
