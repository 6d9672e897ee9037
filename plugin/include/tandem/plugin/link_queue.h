#pragma once

#include <cstdint>
#include <memory>

#include "tandem/coordination/link.h"

#pragma GCC visibility push(default)
namespace tandem {

/// The way to a peer for a site with a HapticLoop: the haptic thread puts states into one queue and
/// takes them from another; the thread that has the socket moves them on. Neither waits for the
/// other, and neither allocates.
class LinkQueue final : public Link {
 public:
  LinkQueue();
  ~LinkQueue() override;

  /// The haptic thread's side. What finds no room is lost, as on the way.
  void send(const StatePacket& packet, double now) noexcept override;
  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept override;

  /// The other side: sends over `link` what waits, and fetches what it will have brought before
  /// `until`, both in the site's time [s]. Twice a period is enough, with `until` two periods
  /// ahead: then everything is there at its moment.
  void exchange(Link& link, double now, double until) noexcept;

  /// States that found no room, both ways.
  [[nodiscard]] std::uint64_t lost() const noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
