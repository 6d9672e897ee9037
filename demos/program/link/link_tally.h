#pragma once

#include <cstdint>

#include "tandem/coordination/datagram_channel.h"
#include "tandem/plugin/duration_histogram.h"

namespace tandem::demos {

/// Impairments of one direction, as asked for or as they came out: means over the datagrams that
/// they apply to, so that settings which changed in between compare, too. Not a number where there
/// was no such datagram.
struct LinkFigures {
  double loss = 0.0, duplicate = 0.0, reorder = 0.0, corrupt = 0.0;  ///< shares, 0..1
  double delay = 0.0;                                                ///< mean [s]
  double jitter = 0.0;  ///< half the width of an even spread with the same deviation [s]
};

/// Asked against achieved in one direction. Delays leave out what was sent on at once (`reorder`);
/// of a jitter above the delay, what is below 0 counts as 0 in what was asked, too.
/// Both note functions are real-time safe.
class LinkTally {
 public:
  void noteSent(const ChannelConditions& conditions, Entrance entrance) noexcept;
  /// A copy that has just been passed on, at `now` [s].
  void noteDelivered(const Delivery& delivery, double now) noexcept;

  [[nodiscard]] LinkFigures asked() const noexcept;
  [[nodiscard]] LinkFigures achieved(const DatagramChannelCounts& counts) const noexcept;
  /// From arrival here to passing on [s].
  [[nodiscard]] const DurationHistogram& delays() const noexcept { return delays_; }
  /// From the moment at which a copy was due to passing it on [s].
  [[nodiscard]] const DurationHistogram& latencies() const noexcept { return latencies_; }

 private:
  // Sums of what was asked, and over how many datagrams.
  double loss_ = 0.0, duplicate_ = 0.0, reorder_ = 0.0, corrupt_ = 0.0;
  std::uint64_t drawn_ = 0;  ///< that loss was drawn for
  std::uint64_t kept_ = 0;   ///< that were not lost

  // Over what was delivered and had a delay.
  std::uint64_t delayed_ = 0;
  double asked_delay_ = 0.0, asked_variance_ = 0.0;
  double deviation_ = 0.0, deviation_squared_ = 0.0;  ///< of the delay from the one asked for

  DurationHistogram delays_, latencies_;
};

}  // namespace tandem::demos
