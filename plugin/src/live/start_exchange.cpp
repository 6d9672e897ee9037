#include "live/start_exchange.h"

#include <algorithm>

namespace tandem {
namespace {

/// The start lies so far ahead that all peers hear of it in time: this, or round trips [s].
constexpr double kCountdown = 1.0;
constexpr double kCountdownTrips = 6.0;
/// Peers must have been live for so long, so that the round trip is right [s].
constexpr double kSettling = 0.3;

}  // namespace

void StartExchange::advance(double now, const std::vector<Peer>& peers) noexcept {
  const PeerId lowest = findLowest(peers);
  learn(peers, lowest);
  if (lowest == self_ && !start_) choose(now, peers);
  if (start_)
    for (const Peer& peer : peers) peer.bridge.setStart(*start_);
  if (now < next_send_.value_or(now)) return;
  for (const Peer& peer : peers) peer.bridge.sendHeld(held_, self_);
  next_send_ = std::max(next_send_.value_or(now) + period_, now);
}

PeerId StartExchange::findLowest(const std::vector<Peer>& peers) const noexcept {
  PeerId lowest = self_;
  for (const Peer& peer : peers) lowest = std::min(lowest, peer.id);
  return lowest;
}

void StartExchange::learn(const std::vector<Peer>& peers, PeerId lowest) noexcept {
  for (const Peer& peer : peers) {
    const auto told = peer.bridge.listenForStart(0.5 * peer.round_trip + peer.wait);
    const bool is_running = told && told->countdown <= 0.0;
    if (!told || start_ || !(is_running || peer.id == lowest)) continue;
    if (told->countdown > longest_)
      refused_ = RefusedCountdown{peer.id, told->countdown};
    else
      start_ = told->start;
  }
}

void StartExchange::choose(double now, const std::vector<Peer>& peers) noexcept {
  double longest_trip = 0.0;
  for (const Peer& peer : peers) {
    if (!peer.is_live || peer.round_trip == 0.0) {
      live_since_.reset();
      return;
    }
    longest_trip = std::max(longest_trip, peer.round_trip);
  }
  if (!live_since_) live_since_ = now;
  if (now - *live_since_ > kSettling)
    start_ = now + std::max(kCountdown, kCountdownTrips * longest_trip);
}

}  // namespace tandem
