#pragma once

#include <vector>

#include "site/bodies.h"
#include "site/grips.h"
#include "site/interest.h"
#include "site/local_hand.h"
#include "site/peers.h"
#include "site/timeline.h"

namespace tandem {

/// Sends this site's state to all peers, each with the objects that it needs to be told of. Packet
/// n leaves at start + n / packet_rate with the island's state of exactly that moment. While
/// nothing moves or touches, packets are rare and marked idle. Real-time safe.
class PacketSender {
 public:
  PacketSender(const SiteSettings& settings, const Island& island, const Timeline& timeline,
               const Bodies& bodies, LocalHand& hand, Peers& peers, const Grips& grips,
               SiteLog& log) noexcept;

  /// After set-up. Allocates.
  void setSize(std::size_t objects, std::size_t peers);

  /// When the next packet is due [s].
  [[nodiscard]] double due() const noexcept {
    return timeline_.start() + static_cast<double>(packets_due_) / settings_.packet_rate;
  }
  /// Sends the packets due by `until` [s]. `is_exact`: the island is at the moment of each packet.
  /// Otherwise its state is sent as that of `until`.
  void sendIfDue(double until, bool is_exact) noexcept;
  /// Skips the packets of lost time.
  void skipTo(double until) noexcept;

  /// Called once a tick. Packets become rare after half a second without motion and touch. The
  /// first motion is sent at once.
  void lookForIdleness(double now) noexcept;

 private:
  [[nodiscard]] bool isStill() const noexcept;
  void send(double time, bool to_all) noexcept;
  void addObjects(StatePacket& packet, const std::vector<std::size_t>& chosen) noexcept;
  [[nodiscard]] bool maySend(const RigidState& state) noexcept;
  [[nodiscard]] PointState limitUser(const PointState& user) noexcept;
  void noteWithheld() noexcept;

  const SiteSettings& settings_;
  const Island& island_;
  const Timeline& timeline_;
  const Bodies& bodies_;
  LocalHand& hand_;
  Peers& peers_;
  const Grips& grips_;
  SiteLog& log_;
  std::uint64_t packets_due_ = 0, sequence_ = 0;
  std::uint64_t idle_stride_;  ///< one packet in this many is sent while rare
  int idle_notices_ = 0;       ///< idle packets left to send at the full rate
  bool is_idle_ = false;
  double busy_until_ = 0.0;  ///< last time of motion or touch [s]
  Interest interest_;
  std::vector<Peer*> due_;  ///< peers that get the packet
  PointState sent_user_;    ///< as last sent, in the frame of the session
};

}  // namespace tandem
