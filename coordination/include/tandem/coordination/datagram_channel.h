#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "tandem/coordination/datagram.h"
#include "tandem/coordination/impairments.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Current effect of a channel on the datagrams sent into one direction.
struct ChannelConditions {
  Impairments impairments;
  double corrupt = 0.0;     ///< probability that one bit of a copy flips, 0..1
  bool keep_order = false;  ///< jitter never reorders datagrams; `reorder` still does
  bool is_cut = false;      ///< new datagrams are dropped; those under way still arrive
};

/// Counts of one direction; each copy counts by itself. `sent - cut_off - too_long - lost +
/// duplicated` equals `delivered` + `overflowed` + the copies still under way.
struct DatagramChannelCounts {
  std::uint64_t sent = 0;
  std::uint64_t cut_off = 0;   ///< dropped because the channel was cut
  std::uint64_t too_long = 0;  ///< dropped because they exceed a slot; never truncated
  std::uint64_t lost = 0;      ///< dropped at random
  std::uint64_t duplicated = 0;
  std::uint64_t reordered = 0;   ///< sent without delay, at random
  std::uint64_t corrupted = 0;   ///< copies with a flipped bit
  std::uint64_t overflowed = 0;  ///< dropped because `capacity` copies were under way
  std::uint64_t delivered = 0;
  std::uint64_t overtaken = 0;  ///< delivered after a later datagram, without duplicates
};

/// Result of DatagramChannel::send().
enum class Entrance : std::uint8_t { kCutOff, kTooLong, kLost, kOnItsWay };

/// A copy that leaves the channel.
struct Delivery {
  ByteView bytes;       ///< valid until the next takeDue()
  double sent = 0.0;    ///< time of sending [s]
  double due = 0.0;     ///< time of arrival [s]
  double delay = 0.0;   ///< `Impairments::delay` at the time of sending [s]
  double jitter = 0.0;  ///< `Impairments::jitter` at the time of sending [s]
  bool is_reordered = false;
};

/// One direction of an impaired channel for datagrams of any content. It does to datagrams what
/// SimulatedLink does to packets, with the same fates for the same seed, and adds
/// ChannelConditions.
///
/// Number n of computeFate() is the n-th datagram sent, even if it was dropped. Conditions may
/// therefore change at any time without shifting later draws. Callers pass the time, which must not
/// go back. Real-time safe after construction; not thread safe.
class DatagramChannel {
 public:
  /// Reserves `capacity` copies of up to `longest` bytes each. Throws std::invalid_argument if one
  /// of them is 0.
  DatagramChannel(Direction direction, std::size_t capacity, std::size_t longest);
  ~DatagramChannel();
  DatagramChannel(DatagramChannel&&) noexcept;
  DatagramChannel& operator=(DatagramChannel&&) noexcept;

  /// Sends a datagram at `now` [s]. The caller checks the conditions with checkConditions().
  Entrance send(ByteView datagram, const ChannelConditions& conditions, double now) noexcept;

  /// Time at which the next copy leaves [s]; infinity if nothing is under way.
  [[nodiscard]] double nextDue() const noexcept;

  /// The next copy that is due by `now` [s], in order of due time; nothing if there is none.
  [[nodiscard]] std::optional<Delivery> takeDue(double now) noexcept;

  [[nodiscard]] const DatagramChannelCounts& counts() const noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

/// Throws std::invalid_argument, naming the value, if a condition is out of range.
void checkConditions(const ChannelConditions& conditions);

}  // namespace tandem
#pragma GCC visibility pop
