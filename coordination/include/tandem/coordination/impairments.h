#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#pragma GCC visibility push(default)
namespace tandem {

/// Effects of an imperfect network on packets. Probabilities are per packet and independent. No
/// copy of a lost packet arrives; the duplicate of a reordered packet keeps its ordinary delay.
struct Impairments {
  double delay = 0.0;      ///< one-way delay [s], >= 0
  double jitter = 0.0;     ///< delay is uniform in delay +- jitter, at least 0 [s]; may reorder
  double loss = 0.0;       ///< probability that a packet never arrives, 0..1
  double duplicate = 0.0;  ///< probability that a packet arrives twice (own jitter each), 0..1
  double reorder =
      0.0;  ///< probability that a packet has no delay and overtakes others (as netem), 0..1
  std::uint64_t seed = 0;  ///< equal seeds give equal fates
};

/// Throws std::invalid_argument, naming the value, if an impairment is out of range.
void checkImpairments(const Impairments& impairments);

/// Forward: client to server, or first to second end of a simulated link.
enum class Direction : std::uint8_t { kForward, kBack };

/// Fate of one packet. The other fields of a lost packet have no meaning.
struct PacketFate {
  bool is_lost = false;
  bool is_reordered = false;
  bool is_duplicated = false;
  double delay = 0.0;            ///< delay of the packet [s]; 0 if it is reordered
  double duplicate_delay = 0.0;  ///< delay of the duplicate, if there is one [s]
};

/// The fate of packet `number` (from 0) of a direction; it depends on the arguments alone. Each
/// impairment has an independent random stream, so enabling one never shifts another. A known seed
/// therefore predicts all fates. Pure; real-time safe.
[[nodiscard]] PacketFate computeFate(const Impairments& impairments, Direction direction,
                                     std::uint64_t number) noexcept;

/// The first or only copy of a packet, and the duplicate.
enum class Copy : std::uint8_t { kFirst, kDuplicate };

/// The bit to flip in a copy of `size` bytes, counted from the lowest bit of the first byte.
/// Nothing if the copy stays whole, as an empty copy always does. Its random streams are
/// independent of those of computeFate(). Pure; real-time safe.
[[nodiscard]] std::optional<std::size_t> computeCorruptBit(double probability, std::uint64_t seed,
                                                           Direction direction,
                                                           std::uint64_t number, Copy copy,
                                                           std::size_t size) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
