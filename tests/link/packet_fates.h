#pragma once

#include <cstdint>
#include <vector>

#include "tandem/coordination/simulated_link.h"

/// \file
/// Fates of packets on a simulated link, as its tests observe them.
namespace tandem {

inline StatePacket makePacket(std::uint64_t sequence) {
  StatePacket packet;
  packet.sequence = sequence;
  return packet;
}

inline std::vector<Arrival> receiveAll(Link& end, double from, double until) {
  std::vector<Arrival> arrivals;
  while (const auto arrival = end.receive(from, until)) arrivals.push_back(*arrival);
  return arrivals;
}

/// Arrival times of each copy of one packet [s], in ascending order; empty if it is lost.
using Fate = std::vector<double>;

/// A packet without delay arrives this long after it was sent [s]. The value is above the rounding
/// of times up to 20000 s, and below any likely random delay.
inline constexpr double kEarliest = 1e-9;

/// Fates of `count` packets. Number n is sent at n seconds and is alone on the link, so only the
/// impairments decide. Copies under way for a second or more are not waited for.
inline std::vector<Fate> observeFates(Link& sender, Link& receiver, std::uint64_t count) {
  std::vector<Fate> fates(count);
  for (std::uint64_t n = 0; n < count; ++n) {
    const double now = static_cast<double>(n);
    sender.send(makePacket(n), now);
    for (const Arrival& arrival : receiveAll(receiver, now + kEarliest, now + 1.0))
      fates.at(arrival.packet.sequence).push_back(arrival.time);
  }
  return fates;
}

inline std::vector<Fate> observeFates(const Impairments& impairments, std::uint64_t count) {
  const auto [a, b] = makeSimulatedLinks(impairments);
  return observeFates(*a, *b, count);
}

}  // namespace tandem
