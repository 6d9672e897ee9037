#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#pragma GCC visibility push(default)
namespace tandem {

/// What an imperfect way does to packets. Probabilities are per packet and independent. Of a lost
/// packet no copy arrives; of a reordered one the duplicate still goes the ordinary way.
struct Impairments {
  double delay = 0.0;      ///< one-way delay [s], >= 0
  double jitter = 0.0;     ///< delay is even in delay +- jitter, not below 0 [s]; may reorder
  double loss = 0.0;       ///< probability that a packet never arrives, 0..1
  double duplicate = 0.0;  ///< probability that a packet arrives twice (own jitter each), 0..1
  double reorder = 0.0;    ///< probability that a packet jumps the queue: no delay (as netem), 0..1
  std::uint64_t seed = 0;  ///< equal seeds, equal fates
};

/// Throws std::invalid_argument, naming the value, for impairments out of range.
void checkImpairments(const Impairments& impairments);

/// Between client and server, or between the first and the second end of a simulated way.
enum class Direction : std::uint8_t { kForward, kBack };

/// What becomes of one packet. Of a lost one, nothing else is of interest.
struct PacketFate {
  bool is_lost = false;
  bool is_reordered = false;
  bool is_duplicated = false;
  double delay = 0.0;            ///< of the packet [s]; 0 if it is reordered
  double duplicate_delay = 0.0;  ///< of its duplicate, if there is one [s]
};

/// The fate of packet `number` (from 0) of a direction. It depends on the arguments and nothing
/// else, by an independent random stream for each impairment: switching one on never shifts
/// another, and whoever knows the seed knows all fates beforehand. Pure; real-time safe.
[[nodiscard]] PacketFate computeFate(const Impairments& impairments, Direction direction,
                                     std::uint64_t number) noexcept;

/// The first or only copy of a packet, and the duplicate.
enum class Copy : std::uint8_t { kFirst, kDuplicate };

/// The bit that is turned in a copy of `size` bytes, counted from the lowest bit of the first byte;
/// nothing if the copy stays whole, as one without bytes always does. Its random streams are
/// independent of those of computeFate(). Pure; real-time safe.
[[nodiscard]] std::optional<std::size_t> computeCorruptBit(double probability, std::uint64_t seed,
                                                           Direction direction,
                                                           std::uint64_t number, Copy copy,
                                                           std::size_t size) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
