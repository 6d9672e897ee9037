#pragma once

#include <optional>

#include "tandem/coordination/packet.h"

#pragma GCC visibility push(default)
namespace tandem {

/// A packet and the moment at which it came in.
struct Arrival {
  StatePacket packet;
  double time = 0.0;  ///< receiver's time [s]
};

/// One end of the way to one other peer. Unreliable and unordered, as UDP is.
///
/// All functions are called from the thread that ticks the site, never block and never allocate.
class Link {
 public:
  virtual ~Link() = default;

  /// Sends one packet whose state belongs to time `now` [s].
  virtual void send(const StatePacket& packet, double now) noexcept = 0;

  /// The next packet, in order of arrival, that has come in before `until` [s] and was on its way
  /// before `from` [s]; nothing if there is none. A tick asks for [from, until) = its own period.
  ///
  /// A simulated link knows the future of the period and gives arrivals inside it, so that virtual
  /// time takes them in at their exact moment; a live link gives what is there and stamps it
  /// `from`.
  [[nodiscard]] virtual std::optional<Arrival> receive(double from, double until) noexcept = 0;
};

}  // namespace tandem
#pragma GCC visibility pop
