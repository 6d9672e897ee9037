#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tandem/plugin/live_peers.h"

#include "preload_config.h"

namespace tandem::preload {

/// The other site of the config, over UDP. The own site goes by the host's simulated time. A host
/// that stands still is silent, and the other site fades it out.
class RemoteSite {
 public:
  /// Throws as readKeyFile() and LivePeers do.
  RemoteSite(const PreloadConfig& config, Configuration agreement);
  /// Says farewell, which takes 0.15 s.
  ~RemoteSite();
  RemoteSite(const RemoteSite&) = delete;
  RemoteSite& operator=(const RemoteSite&) = delete;

  /// The way to it; lives as long as this.
  [[nodiscard]] Link& link() { return peers_.link(peer_); }

  /// Call it before each step of the host, which begins at `site_time` [s].
  void beginStep(double site_time) noexcept;

  /// Describes the change since the last call in one line; empty if nothing changed. Allocates.
  [[nodiscard]] std::optional<std::string> reportChange();

 private:
  PeerId peer_;
  LivePeers peers_;
  std::string reported_;
};

}  // namespace tandem::preload
