#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tandem/coordination/link.h"
#include "tandem/plugin/udp_mesh.h"

#include "preload_config.h"

namespace tandem::preload {

/// UDP link to the other site, for a site that runs in the host's simulated time.
///
/// Times are stamped as if the host ran in real time from the current step on. The ticks of a step
/// run in one go, and would look like jitter otherwise. A host that stands still is silent, and the
/// other site fades it out.
class RemoteSite final : public Link {
 public:
  /// Throws as readKeyFile() and UdpMesh do.
  RemoteSite(const PreloadConfig& config, Configuration agreement);
  /// Says farewell, which takes 0.12 s.
  ~RemoteSite() override;
  RemoteSite(const RemoteSite&) = delete;
  RemoteSite& operator=(const RemoteSite&) = delete;

  /// Call it before each step of the host, which begins at `site_time` [s].
  void beginStep(double site_time) noexcept;

  /// Describes the change since the last call in one line; empty if nothing changed. Allocates.
  [[nodiscard]] std::optional<std::string> reportChange();

  // Link in the site's time.
  void send(const StatePacket& packet, double now) noexcept override;
  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept override;

 private:
  PeerId peer_;
  UdpMesh mesh_;
  Link& link_;
  double ahead_ = 0.0;  ///< clock - site's time [s]
  std::uint64_t sequence_ = 0;
  std::string reported_;
};

}  // namespace tandem::preload
