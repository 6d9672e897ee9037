#pragma once

#include <memory>
#include <vector>

#include "tandem/plugin/datagram_carrier.h"

namespace tandem {

inline constexpr int kHighestDdsDomain = 232;  ///< its ports end below 65536

/// Sealed datagrams as samples of Cyclone DDS, inside a segment whose members are all trusted.
/// Never on a port that strangers reach: malformed traffic makes Cyclone's memory grow.
///
/// Each direction of a pair has a topic of its own. Samples are best effort, and a receiver keeps
/// the newest 64 of each sender. send() and receive() take locks of Cyclone and may allocate, so
/// they are for a network thread: LivePeers::startThread().
class DdsCarrier final : public DatagramCarrier {
 public:
  /// `domain` is 0 to kHighestDdsDomain, the same at all sites; one session has it. Throws
  /// std::invalid_argument for another. Throws tandem::Error if Cyclone cannot open it, such as
  /// without a network.
  DdsCarrier(int domain, PeerId self, const std::vector<PeerId>& peers);
  ~DdsCarrier() override;
  DdsCarrier(const DdsCarrier&) = delete;
  DdsCarrier& operator=(const DdsCarrier&) = delete;

  void send(ByteView datagram, PeerId to) noexcept override;
  [[nodiscard]] std::optional<Received> receive(ByteSpan room) noexcept override;
  void wait(double seconds) const noexcept override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
