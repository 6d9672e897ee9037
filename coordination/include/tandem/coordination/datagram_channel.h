#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "tandem/coordination/datagram.h"
#include "tandem/coordination/impairments.h"

#pragma GCC visibility push(default)
namespace tandem {

/// What a way does to the datagrams of one direction that get onto it now.
struct ChannelConditions {
  Impairments impairments;
  double corrupt = 0.0;     ///< probability that one bit of a copy is turned, 0..1
  bool keep_order = false;  ///< jitter lets none overtake another; `reorder` still does
  bool is_cut = false;      ///< nothing gets onto the way; what is on it still arrives
};

/// Counts of one direction. At any time `sent - cut_off - too_long - lost + duplicated` is what was
/// `delivered`, what `overflowed` and what is still under way; each copy counts by itself.
struct DatagramChannelCounts {
  std::uint64_t sent = 0;
  std::uint64_t cut_off = 0;   ///< came while the way was cut
  std::uint64_t too_long = 0;  ///< longer than a slot; never cut short
  std::uint64_t lost = 0;      ///< by chance
  std::uint64_t duplicated = 0;
  std::uint64_t reordered = 0;   ///< sent on without delay, by chance
  std::uint64_t corrupted = 0;   ///< copies with a turned bit
  std::uint64_t overflowed = 0;  ///< dropped because `capacity` copies were under way
  std::uint64_t delivered = 0;
  std::uint64_t overtaken = 0;  ///< delivered after one that was sent later; duplicates not counted
};

/// What became of a datagram at the entrance.
enum class Entrance : std::uint8_t { kCutOff, kTooLong, kLost, kOnItsWay };

/// A copy that leaves the way.
struct Delivery {
  ByteView bytes;       ///< until the next call of takeDue()
  double sent = 0.0;    ///< [s]
  double due = 0.0;     ///< [s]
  double delay = 0.0;   ///< `Impairments::delay` when it was sent [s]
  double jitter = 0.0;  ///< `Impairments::jitter` when it was sent [s]
  bool is_reordered = false;
};

/// One direction of an imperfect way for datagrams of any content: what SimulatedLink does to
/// packets, with the same fates for the same seed, and more (ChannelConditions).
///
/// Number n of computeFate() is the n-th datagram that was sent, whatever became of it, so that
/// conditions may change at any time without shifting the draws of what follows. Time is what the
/// calls are told, and must not go back. Real-time safe after construction; not thread safe.
class DatagramChannel {
 public:
  /// Room for `capacity` copies of up to `longest` bytes each. Throws std::invalid_argument if one
  /// of them is 0.
  DatagramChannel(Direction direction, std::size_t capacity, std::size_t longest);
  ~DatagramChannel();
  DatagramChannel(DatagramChannel&&) noexcept;
  DatagramChannel& operator=(DatagramChannel&&) noexcept;

  /// Conditions out of range are the caller's to refuse: checkConditions().
  Entrance send(ByteView datagram, const ChannelConditions& conditions, double now) noexcept;

  /// When the next copy leaves [s]; infinity if nothing is under way.
  [[nodiscard]] double nextDue() const noexcept;

  /// The next copy that is due by `now`, in the order of the times at which they are.
  [[nodiscard]] std::optional<Delivery> takeDue(double now) noexcept;

  [[nodiscard]] const DatagramChannelCounts& counts() const noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

/// Throws std::invalid_argument, naming the value, for conditions out of range.
void checkConditions(const ChannelConditions& conditions);

}  // namespace tandem
#pragma GCC visibility pop
