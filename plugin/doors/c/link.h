#pragma once

#include <memory>
#include <optional>

#include "tandem/coordination/link.h"
#include "tandem/plugin/live_peers.h"

#include "c/handle.h"
#include "live/spsc_ring.h"

namespace tandem::c_door {

/// A link whose packets the caller carries, from any one thread.
class ManualLink final : public Link {
 public:
  static constexpr std::size_t kRoom = 256;  ///< packets each way

  // For the caller.
  /// Returns false if the queue is full.
  bool push(const StatePacket& packet) noexcept { return arrivals_.push(packet); }
  [[nodiscard]] const StatePacket* peek() const noexcept { return departures_.peek(); }
  void drop() noexcept { departures_.drop(); }

  // For the site.
  void send(const StatePacket& packet, double) noexcept override { (void)departures_.push(packet); }
  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept override;

 private:
  SpscRing<StatePacket> departures_{kRoom}, arrivals_{kRoom};
};

/// The mesh that a link belongs to, and the peer to whom it leads.
struct MeshWay {
  HandleHead* mesh = nullptr;
  LivePeers* peers = nullptr;
  PeerId peer{};

  /// From here on a loop ticks the link's site, or none does any more.
  void setLoop(bool has_one) const { peers->setHapticThread(peer, has_one); }
};

struct LinkEnd {
  static constexpr std::uint32_t kKind = 0x546c494e;
  static constexpr const char* kName = "link";
  static constexpr const char* kUser = "a site";

  std::unique_ptr<Link> own;  ///< null: the mesh owns the link
  Link* link = nullptr;
  bool is_simulated = false;
  ManualLink* manual = nullptr;  ///< null: a link of another kind
  std::optional<MeshWay> mesh;   ///< nothing: a link of another kind
};

}  // namespace tandem::c_door

struct TandemLink : tandem::c_door::Handle<tandem::c_door::LinkEnd> {};
