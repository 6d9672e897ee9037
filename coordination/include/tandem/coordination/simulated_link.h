#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "tandem/coordination/impairments.h"
#include "tandem/coordination/link.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Counts of one direction; each copy of a duplicated packet counts by itself. `sent - lost +
/// duplicated` equals `delivered` + `overflowed` + the packets still in flight.
struct ChannelCounts {
  std::uint64_t sent = 0;
  std::uint64_t lost = 0;
  std::uint64_t duplicated = 0;
  std::uint64_t reordered = 0;
  std::uint64_t overflowed = 0;  ///< dropped because `capacity` packets were in flight
  std::uint64_t delivered = 0;
};

/// One end of a simulated link; reports the counts of the packets it sent.
class SimulatedLink : public Link {
 public:
  [[nodiscard]] virtual const ChannelCounts& counts() const noexcept = 0;
};

/// Makes both ends of a link with delay, jitter, loss, duplicates and reordering.
///
/// Deterministic: the fate of a packet depends only on the seed, the direction and the packet's
/// number (computeFate()). Time is virtual: only the times passed to send() and receive() count. At
/// most `capacity` packets are in flight in a direction; a further one is dropped and counted.
/// receive() never returns a packet in the tick that sent it, however early it arrives. send() and
/// receive() never allocate. Not thread safe. Either end may outlive the other. Throws
/// std::invalid_argument, naming the value, for impairments out of range or no capacity.
[[nodiscard]] std::pair<std::unique_ptr<SimulatedLink>, std::unique_ptr<SimulatedLink>>
makeSimulatedLinks(const Impairments& impairments, std::size_t capacity = 1024);

}  // namespace tandem
#pragma GCC visibility pop
