#include "remote_site.h"

#include <utility>

#include "tandem/falcon/monotonic_clock.h"
#include "tandem/plugin/key_file.h"

namespace tandem::preload {
namespace {

UdpMeshSettings makeSettings(const PreloadConfig& config, Configuration agreement) {
  UdpMeshSettings settings;
  settings.self = config.site.self;
  settings.bind = config.link->bind;
  settings.playout.is_on = config.link->playout;
  settings.configuration = std::move(agreement);
  return settings;
}

std::vector<UdpPeer> makePeers(const PreloadLink& link) {
  std::vector<UdpPeer> peers;
  peers.push_back({link.peer, link.address, readKeyFile(link.key)});
  return peers;
}

}  // namespace

RemoteSite::RemoteSite(const PreloadConfig& config, Configuration agreement)
    : peer_(config.link->peer),
      peers_(makeSettings(config, std::move(agreement)), makePeers(*config.link)) {}

RemoteSite::~RemoteSite() { peers_.sayFarewell(ByeReason::kProgramEnds); }

void RemoteSite::beginStep(double site_time) noexcept {
  peers_.poll(readMonotonicClock(), site_time);
}

std::optional<std::string> RemoteSite::reportChange() {
  const PeerStatus status = peers_.status(peer_, readMonotonicClock());
  std::string report =
      "site " + std::to_string(static_cast<std::uint32_t>(peer_)) + " is " + name(status.phase);
  if (status.difference)
    report += ": " + status.difference->key + " is " + status.difference->here + " here and " +
              status.difference->there + " there";
  if (report == reported_) return std::nullopt;
  reported_ = report;
  return report;
}

}  // namespace tandem::preload
