#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>

#include "tandem/coordination/link.h"
#include "tandem/plugin/udp_socket.h"

#include "relay/watch_wire.h"
#include "secure/seal.h"

namespace tandem::relay {

/// Tells all spectators of a room what a site tells its peers: one datagram in kPeriod, however
/// many peers and spectators there are. It opens nothing. Real-time safe after construction.
class WatchFeed {
 public:
  /// A quarter of the states at 128 Hz, and enough for the eye: at 0.1 m/s a step is 3 mm [s].
  static constexpr double kPeriod = 1.0 / 32.0;

  /// `outlet` sends to relayed addresses, and must outlive this. Each run needs a `run` of its own.
  /// Throws as SecretKey does.
  WatchFeed(const SecretKey& watch_key, PeerId self, const WatchRun& run, WireProfile profile,
            std::uint32_t config_hash, net::Outlet& outlet);

  /// Takes a packet to any peer. Sends when a period is over.
  void take(const StatePacket& packet, double now) noexcept;

 private:
  void note(const StatePacket& packet) noexcept;
  void pickObjects() noexcept;
  void send(double now) noexcept;

  WatchHeader header_;
  secure::Sealer sealer_;
  WireProfile profile_;
  std::uint32_t config_hash_;
  net::Outlet& outlet_;
  std::optional<double> next_;  ///< empty: nothing was sent yet [s]

  StatePacket newest_;  ///< its objects are those that the next datagram says
  // Peers are told of different objects, so the feed collects them.
  std::array<ObjectState, kMaxSharedObjects> objects_;
  std::bitset<kMaxSharedObjects> has_news_;
  std::size_t turn_ = 0;
};

/// A link to a peer whose packets spectators get, too.
class WatchedLink final : public Link {
 public:
  WatchedLink(Link& link, WatchFeed& feed) noexcept : link_(link), feed_(feed) {}
  void send(const StatePacket& packet, double now) noexcept override {
    link_.send(packet, now);
    feed_.take(packet, now);
  }
  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept override {
    return link_.receive(from, until);
  }
  [[nodiscard]] bool hasLeft() const noexcept override { return link_.hasLeft(); }

 private:
  Link& link_;
  WatchFeed& feed_;
};

}  // namespace tandem::relay
