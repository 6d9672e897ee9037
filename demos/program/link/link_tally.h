#pragma once

#include <cstdint>

#include "tandem/coordination/datagram_channel.h"
#include "tandem/plugin/duration_histogram.h"

namespace tandem::demos {

/// Impairments of one direction, asked or achieved. These are means over the datagrams that they
/// apply to, so that changed settings compare too. NaN if there was no such datagram.
struct LinkFigures {
  double loss = 0.0, duplicate = 0.0, reorder = 0.0, corrupt = 0.0;  ///< shares, 0..1
  double delay = 0.0;                                                ///< mean [s]
  double jitter = 0.0;  ///< half width of a uniform spread with the same deviation [s]
};

/// Compares asked with achieved in one direction. Delays exclude datagrams sent on at once
/// (`reorder`). If jitter exceeds the delay, values below 0 count as 0 in the asked spread too.
/// Both note functions are real-time safe.
class LinkTally {
 public:
  void noteSent(const ChannelConditions& conditions, Entrance entrance) noexcept;
  /// Notes a copy that was passed on at `now` [s].
  void noteDelivered(const Delivery& delivery, double now) noexcept;

  [[nodiscard]] LinkFigures asked() const noexcept;
  [[nodiscard]] LinkFigures achieved(const DatagramChannelCounts& counts) const noexcept;
  /// Times from arrival here to passing on [s].
  [[nodiscard]] const DurationHistogram& delays() const noexcept { return delays_; }
  /// Times from a copy's due moment to passing it on [s].
  [[nodiscard]] const DurationHistogram& latencies() const noexcept { return latencies_; }

 private:
  // Sums of the asked values, and their number of datagrams.
  double loss_ = 0.0, duplicate_ = 0.0, reorder_ = 0.0, corrupt_ = 0.0;
  std::uint64_t drawn_ = 0;  ///< those that loss was drawn for
  std::uint64_t kept_ = 0;   ///< those that were not lost

  // Sums over delivered datagrams with a delay.
  std::uint64_t delayed_ = 0;
  double asked_delay_ = 0.0, asked_variance_ = 0.0;
  double deviation_ = 0.0, deviation_squared_ = 0.0;  ///< deviation of the delay from the asked one

  DurationHistogram delays_, latencies_;
};

}  // namespace tandem::demos
