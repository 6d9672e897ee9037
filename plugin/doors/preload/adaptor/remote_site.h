#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tandem/coordination/link.h"
#include "tandem/plugin/udp_mesh.h"

#include "preload_config.h"

namespace tandem::preload {

/// The way to the other site over UDP, for a site that goes by the host's simulated time.
///
/// States are stamped as if the host ran in real time from the step that is being done, so a step's
/// ticks, which run in one go, do not look like jitter. A host that stands still is silent, and the
/// other site fades it out.
class RemoteSite final : public Link {
 public:
  /// Throws as readKeyFile() and UdpMesh do.
  RemoteSite(const PreloadConfig& config, Configuration agreement);
  /// Says farewell, which takes a tenth of a second.
  ~RemoteSite() override;
  RemoteSite(const RemoteSite&) = delete;
  RemoteSite& operator=(const RemoteSite&) = delete;

  /// Before each step of the host, which begins at `site_time` [s].
  void beginStep(double site_time) noexcept;

  /// What has changed since it was asked last, in one line; nothing if nothing has. Allocates.
  [[nodiscard]] std::optional<std::string> reportChange();

  // Link, in the site's time.
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
