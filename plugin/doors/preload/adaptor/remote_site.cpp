#include "remote_site.h"

#include <algorithm>
#include <utility>

#include "tandem/falcon/monotonic_clock.h"
#include "tandem/plugin/key_file.h"

namespace tandem::preload {
namespace {

constexpr double kFarewell = 0.12;  ///< time to send the farewell [s]

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
      mesh_(makeSettings(config, std::move(agreement)), makePeers(*config.link)),
      link_(mesh_.link(peer_)) {}

RemoteSite::~RemoteSite() {
  const double until = readMonotonicClock() + kFarewell;
  mesh_.leave(readMonotonicClock(), ByeReason::kProgramEnds);
  while (readMonotonicClock() < until) {
    mesh_.poll(readMonotonicClock());
    mesh_.wait(5e-3);
  }
}

void RemoteSite::beginStep(double site_time) noexcept {
  const double now = readMonotonicClock();
  ahead_ = now - site_time;
  mesh_.poll(now);
}

std::optional<std::string> RemoteSite::reportChange() {
  const PeerStatus status = mesh_.status(peer_, readMonotonicClock());
  std::string report =
      "site " + std::to_string(static_cast<std::uint32_t>(peer_)) + " is " + name(status.phase);
  if (status.difference)
    report += ": " + status.difference->key + " is " + status.difference->here + " here and " +
              status.difference->there + " there";
  if (report == reported_) return std::nullopt;
  reported_ = report;
  return report;
}

void RemoteSite::send(const StatePacket& packet, double now) noexcept {
  StatePacket stamped = packet;
  // A site restarts when its object comes back; the sequence must go on.
  stamped.sequence = sequence_++;
  link_.send(stamped, now + ahead_);
}

std::optional<Arrival> RemoteSite::receive(double from, double until) noexcept {
  auto arrival = link_.receive(from + ahead_, until + ahead_);
  if (arrival) arrival->time = std::max(arrival->time - ahead_, from);
  return arrival;
}

}  // namespace tandem::preload
