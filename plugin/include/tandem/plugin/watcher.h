#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "tandem/coordination/link.h"
#include "tandem/plugin/udp_mesh.h"

#pragma GCC visibility push(default)
namespace tandem {

/// A spectator has heard this of one site.
struct WatchedSite {
  StatePacket newest;             ///< some of the site's objects; Watcher::object() knows all
  double heard_at = 0.0;          ///< by the clock of Watcher::poll() [s]
  std::uint32_t config_hash = 0;  ///< the site's UdpMeshSettings::watch_hash
  std::uint64_t states = 0;       ///< taken so far
};

/// A spectator in a room of a relay: hears the states of all sites that have the same watch key,
/// and can send none. It says nothing but the admission to the relay and what keeps it there.
///
/// Whoever has the watch key can show other spectators false pictures, but no site opens anything
/// under it. A spectator takes one of the room's ids from 17 to 64, another if it is taken.
///
/// One thread. poll() takes at most 128 datagrams, never blocks and never allocates.
class Watcher {
 public:
  /// `access.watch_key` is required. Takes 2.5 MB. Throws std::invalid_argument for settings out of
  /// range or an address that cannot be bound, tandem::Error if the system gives no socket.
  explicit Watcher(RelayAccess access, const Address& bind = {});
  ~Watcher();
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  /// Takes the received datagrams and sends what keeps it in the room. `now` [s] is any clock that
  /// does not run back. Call it at least 20 times a second.
  void poll(double now) noexcept;
  /// Waits for a datagram, at most `seconds`.
  void wait(double seconds) const noexcept;

  /// Newest state of a site; null if it was not heard. Valid until the next poll().
  [[nodiscard]] const WatchedSite* latest(PeerId site) const noexcept;
  /// Newest state of a site's copy of an object; null if it was not heard. Valid as latest().
  [[nodiscard]] const ObjectState* object(PeerId site, ObjectId id) const noexcept;
  /// Sites that were heard, by id. Allocates.
  [[nodiscard]] std::vector<PeerId> heard() const;

  [[nodiscard]] RelayConnection relay(double now) const;
  /// Reasons that occurred so far (docs/relay.md). Allocates.
  [[nodiscard]] std::vector<RefusedDatagrams> refused() const;
  [[nodiscard]] Address bound() const noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
