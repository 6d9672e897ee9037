#pragma once

#include <algorithm>
#include <vector>

#include "net/virtual_net.h"

/// \file
/// Parts of tests in which somebody on the way, without the key, attacks a pair of sites.
namespace tandem::test {

/// An address that no site has.
inline const Address kStranger = VirtualNet::addressOf(9);

[[nodiscard]] inline MessageType typeOf(const Bytes& bytes) {
  return static_cast<MessageType>(bytes[3]);
}

/// Sends datagrams of an attacker's own into a network.
class Injector {
 public:
  explicit Injector(VirtualNet& net) : net_(net) {}

  /// Called from the network's tap, it sends before the overheard datagram goes on: the own one
  /// arrives first.
  void send(const Bytes& bytes, const Address& from, const Address& to) {
    is_own_ = true;
    net_.carry(bytes, from, to);
    is_own_ = false;
  }
  /// True in the network's tap if it overhears an own datagram.
  [[nodiscard]] bool isOwn() const { return is_own_; }

 private:
  VirtualNet& net_;
  bool is_own_ = false;
};

/// The longest time without a state, until the time `until` [s].
[[nodiscard]] inline double longestGap(const std::vector<Arrival>& given, double until) {
  double longest = given.empty() ? 1e9 : until - given.back().time;
  for (std::size_t i = 1; i < given.size(); ++i)
    longest = std::max(longest, given[i].time - given[i - 1].time);
  return longest;
}

/// Runs a pair for so many seconds: the longest time without a state, at either site [s].
[[nodiscard]] inline double longestGapOver(VirtualSites& sites, double seconds) {
  sites.forgetGiven();
  sites.run(seconds);
  return std::max(longestGap(sites.at(1).given[2], sites.clock()),
                  longestGap(sites.at(2).given[1], sites.clock()));
}

}  // namespace tandem::test
