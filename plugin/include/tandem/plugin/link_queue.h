#pragma once

#include <cstdint>
#include <memory>

#include "tandem/coordination/link.h"

#pragma GCC visibility push(default)
namespace tandem {

/// A link for a site with a HapticLoop. The haptic thread sends to one queue and receives from
/// another; the thread with the socket forwards them. Neither thread waits for the other, and
/// neither allocates.
class LinkQueue final : public Link {
 public:
  LinkQueue();
  ~LinkQueue() override;

  /// For the haptic thread. Packets that find the queue full are lost, as on a network.
  void send(const StatePacket& packet, double now) noexcept override;
  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept override;
  /// As of the last exchange().
  [[nodiscard]] bool hasLeft() const noexcept override;

  /// For the network thread. Sends the queued packets over `link` and fetches those that arrive
  /// before `until`, both in the site's time [s]. Call it twice a period with `until` two periods
  /// ahead; then each packet is there in time.
  void exchange(Link& link, double now, double until) noexcept;

  /// Packets lost to a full queue, both ways.
  [[nodiscard]] std::uint64_t lost() const noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
