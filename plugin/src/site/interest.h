#pragma once

#include <optional>
#include <vector>

#include "site/bodies.h"
#include "site/byte_budget.h"
#include "site/peers.h"
#include "site/told_objects.h"

namespace tandem {

// clang-format off
/// Decides what each peer needs to be told. It acts only if the objects do not fit one packet, or
/// the budget does not suffice for all packets.
///
///   an object    is urgent by its nearness to the hands of both users: see ToldObjects
///   a near peer  gets every packet: the hands are near each other, or reach the same object
///   a far peer   gets rare packets, while the budget binds: one per kIdlePacketPeriod, every other
///                one of these while bytes are short, and one more when an object begins to move
///
/// Near peers come first, and may exceed the budget. For the thread that ticks; real-time safe after
/// setSize().
// clang-format on
class Interest {
 public:
  Interest(const SiteSettings& settings, const Island& island, const Bodies& bodies,
           const Peers& peers) noexcept;

  /// After set-up. Allocates.
  void setSize(std::size_t objects, std::size_t peers);

  /// Looks at the objects, and at a part of the peers, for packet `number` of `time` [s]. `user` is
  /// the local hand in W, with its `grip`.
  void look(const PointState& user, const std::optional<GripState>& grip, std::uint64_t number,
            double time) noexcept;
  /// True if the peer gets that packet.
  [[nodiscard]] bool isDue(const Peer& peer) const noexcept;
  /// True if the peer is told that packets are rare.
  [[nodiscard]] bool isFar(const Peer& peer) const noexcept;
  /// Objects of the packet to a peer; `sharers` peers are still to get it, this one too. Valid
  /// until the next call.
  [[nodiscard]] const std::vector<std::size_t>& choose(const Peer& peer, std::size_t sharers,
                                                       double time) noexcept;

 private:
  /// All that is kept of one peer, by its place.
  struct Audience {
    explicit Audience(double packet_rate) noexcept : told(packet_rate) {}
    ToldObjects told;
    HeldNearness nearness;                     ///< of both users
    int notices = 0;                           ///< packets left that only say that they get rare
    std::optional<std::uint64_t> rejoined_by;  ///< as of the peer
  };

  [[nodiscard]] Reach makeReach(const PointState& user, double radius, PeerId id,
                                const std::optional<GripState>& grip) const noexcept;
  void look(const Peer& peer, const Reach& local, double time) noexcept;
  [[nodiscard]] bool isTurnOf(const Peer& peer, std::uint64_t stride) const noexcept;
  [[nodiscard]] PacketRoom computeRoom(const Peer& peer, std::size_t sharers) const noexcept;

  const SiteSettings& settings_;
  const Island& island_;
  const Bodies& bodies_;
  const Peers& peers_;
  std::vector<ObjectMotion> motions_;  ///< by object
  std::vector<Audience> audiences_;    ///< by peer
  ByteBudget budget_;
  std::uint64_t stride_;      ///< one packet in this many goes to a far peer
  std::uint64_t number_ = 0;  ///< of the packet
  bool is_choosing_ = false;  ///< the objects do not fit, or the budget binds
  bool is_bound_ = false;     ///< the budget binds
  bool has_grip_ = false;     ///< packets tell a grip
  bool has_begun_ = false;    ///< an object begins to move
};

}  // namespace tandem
