#include "peer/peer_line.h"

#include <cstdio>
#include <utility>

#include <fmt/format.h>

#include "tandem/plugin/key_file.h"

#include "peer/dds/dds_bus.h"
#include "peer/dds/dds_domain.h"
#include "peer/peer_configuration.h"
#include "peer/site_values.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

/// On a bus sites find each other.
void checkCarried(const PeerLine& line) {
  (void)readDdsDomain("--carrier", line.carrier);
  if (!(line.bind.empty() && line.peers.empty() && line.relay.empty()))
    throw UsageError("--carrier " + line.carrier +
                     ": has no addresses; leave out --bind, --peer and --relay");
}

/// The lower of two sites calls the other, and needs its address.
void checkWays(const PeerLine& line, int count) {
  if (line.peers.empty() && line.relay.empty())
    throw UsageError("--peer is required, or --relay and --relay-key");
  checkSiteValues("--peer", line.peers, line.site, count);
  for (const std::string& word : line.peers)
    if (count > 2 && !parseSiteValue(word).site)
      throw UsageError(
          fmt::format("--peer {}: say which of {} sites it is: --peer N={}", word, count, word));
  for (int other = line.site + 1; other <= count && line.relay.empty(); ++other)
    if (!findValue(line.peers, other))
      throw UsageError(fmt::format(
          "--peer: site {} calls site {}, and needs its address: --peer {}=HOST:PORT, or --relay",
          line.site, other, other));
}

void checkKeys(const PeerLine& line, int count) {
  checkSiteValues("--key", line.keys, line.site, count);
  for (int other = 1; other <= count; ++other)
    if (other != line.site && !findValue(line.keys, other))
      throw UsageError(fmt::format(
          "--key: none for site {}: give --key {}=FILE, or --key FILE for all", other, other));
}

}  // namespace

void declarePeerLine(Arguments& arguments, PeerLine& line) {
  arguments.option("--site", line.site, "which site this is: 1, 2 and so on");
  arguments.option("--bind", line.bind, "own address, e.g. :7001");
  arguments.repeated(
      "--peer", line.peers,
      "another site's address, e.g. host:7002; with more than two sites 2=host:7002");
  arguments.repeated("--key", line.keys,
                     "key file that all sites share, or 2=FILE: shared with site 2 alone");
  arguments.option("--relay", line.relay, "a relay where all sites meet, e.g. host:7000");
  arguments.option("--relay-key", line.relay_key, "key file of the relay");
  arguments.option("--room", line.room, "room of the relay, the same for all sites");
  arguments.option("--watch-key", line.watch_key,
                   "key file of the room's spectators, who see this site 32 times a second");
  arguments.option("--wait", line.patience, "seconds to wait for the other sites");
  arguments.option("--playout", line.playout,
                   "on: jitter becomes constant delay; off: states are applied as they come",
                   {.choices = {"on", "off"}});
  arguments.option("--wire", line.profile, "width of numbers on the way",
                   {.choices = {"float32", "float64"}});
}

void checkPatience(const PeerLine& line) {
  if (!(line.patience > 0.0 && line.patience <= 86400.0))
    throw UsageError("--wait: must be above 0 and at most 86400 s");
}

void checkPeerLine(const PeerLine& line, std::size_t count) {
  const int last = static_cast<int>(count);
  if (line.relay.empty() != line.relay_key.empty())
    throw UsageError("--relay and --relay-key go together; give both or none");
  if (!line.watch_key.empty() && line.relay.empty())
    throw UsageError("--watch-key needs --relay: the relay copies states to the spectators");
  if (line.site < 1 || line.site > last)
    throw UsageError(
        fmt::format("--site {}: must be 1 {} {}", line.site, last == 2 ? "or" : "to", last));
  checkPatience(line);
  line.isByUdp() ? checkWays(line, last) : checkCarried(line);
  checkKeys(line, last);
}

std::unique_ptr<DatagramCarrier> makeCarrier(const PeerLine& line, std::size_t count) {
  if (line.isByUdp()) return nullptr;
  std::vector<PeerId> others;
  for (int site = 1; site <= static_cast<int>(count); ++site)
    if (site != line.site) others.push_back(PeerId{static_cast<std::uint32_t>(site)});
  return makeDdsCarrier(readDdsDomain("--carrier", line.carrier),
                        PeerId{static_cast<std::uint32_t>(line.site)}, others);
}

UdpMeshSettings makeMeshSettings(const PeerLine& line, const ChangedScenario& scenario) {
  UdpMeshSettings settings;
  settings.self = PeerId{static_cast<std::uint32_t>(line.site)};
  if (line.isByUdp()) settings.bind = resolveAddress(line.bind);
  settings.profile = line.profile == "float64" ? WireProfile::kFloat64 : WireProfile::kFloat32;
  settings.playout.is_on = line.playout == "on";
  Configuration items = makePeerConfiguration(scenario.scenario);
  if (const auto change = describeChange(scenario)) items.push_back(*change);
  items.push_back({"wire.profile", line.profile});
  settings.configuration = makeConfiguration(std::move(items));
  settings.watch_hash = hashWatchedScenario(scenario.scenario);
  return settings;
}

std::vector<UdpPeer> makeOtherSites(const PeerLine& line, std::size_t count) {
  std::vector<UdpPeer> others;
  bool are_locked = true;
  for (int site = 1; site <= static_cast<int>(count); ++site) {
    if (site == line.site) continue;
    UdpPeer other{PeerId{static_cast<std::uint32_t>(site)}, std::nullopt,
                  readKeyFile(findValue(line.keys, site).value_or(""))};
    if (const auto address = findValue(line.peers, site)) other.address = resolveAddress(*address);
    are_locked &= other.key.isLocked();
    others.push_back(std::move(other));
  }
  if (!are_locked)
    fmt::print(stderr, "tandem: note: the key may be swapped to disk; raise ulimit -l\n");
  return others;
}

std::optional<RelayAccess> makeRelayAccess(const PeerLine& line) {
  if (line.relay.empty()) return std::nullopt;
  RelayAccess access{resolveAddress(line.relay), readKeyFile(line.relay_key), line.room};
  if (!line.watch_key.empty()) access.watch_key = readKeyFile(line.watch_key);
  return access;
}

}  // namespace tandem::demos
