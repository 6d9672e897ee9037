#pragma once

#include <cstdint>
#include <optional>

#include "tandem/plugin/watcher.h"

#include "peer/peer_line.h"
#include "scenario/scenario.h"

namespace tandem::demos {

/// The way of a spectator into the room. Throws UsageError for missing options, and as
/// makeRelayAccess() does.
[[nodiscard]] RelayAccess makeWatchAccess(const PeerLine& line);

/// Judges what a spectator hears: whether it is of the spectator's own scenario, and whether
/// anything comes at all.
class WatchCheck {
 public:
  /// Without a `scenario` any one fits. `patience` until a site is heard [s]; `now` is the clock of
  /// Watcher::poll() [s].
  WatchCheck(const Scenario* scenario, double patience, double now);

  /// True if the site has the spectator's scenario, whatever its users, scheme and gains.
  [[nodiscard]] bool fits(const WatchedSite& site) const noexcept;

  /// Call it after each poll. Throws UsageError if sites were heard, but none whose scenario fits;
  /// tandem::Error if the watch key opens nothing, or nobody was heard in time.
  void check(const Watcher& watcher, double now);

 private:
  void checkSilence(const Watcher& watcher, double now);

  std::optional<std::uint32_t> hash_;
  double patience_, begun_;
  std::optional<double> first_forged_;  ///< [s]
};

}  // namespace tandem::demos
