#pragma once

#include <memory>

#include "tandem/coordination/link.h"

#include "c/handle.h"
#include "live/spsc_ring.h"

namespace tandem::c_door {

/// A way whose packets the caller carries, from a thread of its own if need be.
class ManualLink final : public Link {
 public:
  static constexpr std::size_t kRoom = 256;  ///< packets each way

  // The caller's side.
  /// False: there is no room.
  bool push(const StatePacket& packet) noexcept { return arrivals_.push(packet); }
  [[nodiscard]] const StatePacket* peek() const noexcept { return departures_.peek(); }
  void drop() noexcept { departures_.drop(); }

  // The site's side.
  void send(const StatePacket& packet, double) noexcept override { (void)departures_.push(packet); }
  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept override;

 private:
  SpscRing<StatePacket> departures_{kRoom}, arrivals_{kRoom};
};

class MeshLink;

struct LinkEnd {
  static constexpr std::uint32_t kKind = 0x546c494e;
  static constexpr const char* kName = "link";
  static constexpr const char* kUser = "a site";

  std::unique_ptr<Link> own;  ///< null: the mesh's
  Link* link = nullptr;
  bool is_simulated = false;
  ManualLink* manual = nullptr;   ///< null: of another kind
  MeshLink* mesh_link = nullptr;  ///< null: of another kind
  HandleHead* mesh = nullptr;     ///< that it belongs to
};

}  // namespace tandem::c_door

struct TandemLink : tandem::c_door::Handle<tandem::c_door::LinkEnd> {};
