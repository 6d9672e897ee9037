#include "tandem/coordination/simulated_link.h"

#include <algorithm>
#include <vector>

#include "bad_value.h"
#include "link/flight_queue.h"

// clang-format off
//   send(packet, now)                                            receive(from, until)
//        |                                                               ^
//      lost? ----> launch: now + delay +- jitter, or now if reordered    | earliest arrival < until
//        |                                    \                          | that was sent < from
//        +-------> launch: the duplicate ------> heap of packets in flight
//
// The heap orders small entries; the packets stay in their slots from send() to receive(). Fates
// come from computeFate().
// clang-format on

namespace tandem {
namespace {

/// One direction of the link.
class Channel {
 public:
  Channel(const Impairments& impairments, Direction direction, std::size_t capacity)
      : impairments_(impairments), direction_(direction), queue_(capacity), packets_(capacity) {
    held_back_.reserve(capacity);
  }

  void send(const StatePacket& packet, double now) noexcept {
    const PacketFate fate = computeFate(impairments_, direction_, counts_.sent++);
    if (fate.is_lost) {
      ++counts_.lost;
      return;
    }
    if (fate.is_reordered) ++counts_.reordered;
    launch(packet, now, now + fate.delay);
    if (fate.is_duplicated) {
      ++counts_.duplicated;
      launch(packet, now, now + fate.duplicate_delay);
    }
  }

  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept {
    std::optional<Arrival> arrival;
    while (!arrival && !queue_.isEmpty() && queue_.earliest().arrival < until) {
      const FlightQueue::Flight flight = queue_.takeEarliest();
      if (flight.sent < from) {
        arrival = Arrival{packets_[flight.slot], std::max(flight.arrival, from)};
        queue_.release(flight.slot);
        ++counts_.delivered;
      } else {
        held_back_.push_back(flight);  // sent in this very tick: a later tick receives it
      }
    }
    for (const FlightQueue::Flight& flight : held_back_) queue_.putBack(flight);
    held_back_.clear();
    return arrival;
  }

  [[nodiscard]] const ChannelCounts& counts() const noexcept { return counts_; }

 private:
  void launch(const StatePacket& packet, double sent, double arrival) noexcept {
    if (const auto slot = queue_.launch(sent, arrival)) {
      packets_[*slot] = packet;
    } else {
      ++counts_.overflowed;
    }
  }

  Impairments impairments_;
  Direction direction_;
  ChannelCounts counts_;
  FlightQueue queue_;
  std::vector<FlightQueue::Flight> held_back_;  // empty between calls; never allocates
  std::vector<StatePacket> packets_;            // by slot
};

class SimulatedEnd final : public SimulatedLink {
 public:
  SimulatedEnd(std::shared_ptr<Channel> outgoing, std::shared_ptr<Channel> incoming)
      : outgoing_(std::move(outgoing)), incoming_(std::move(incoming)) {}

  void send(const StatePacket& packet, double now) noexcept override {
    outgoing_->send(packet, now);
  }

  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept override {
    return incoming_->receive(from, until);
  }

  [[nodiscard]] const ChannelCounts& counts() const noexcept override {
    return outgoing_->counts();
  }

 private:
  // Shared by both ends, so that either may be destroyed first.
  std::shared_ptr<Channel> outgoing_;
  std::shared_ptr<Channel> incoming_;
};

}  // namespace

std::pair<std::unique_ptr<SimulatedLink>, std::unique_ptr<SimulatedLink>> makeSimulatedLinks(
    const Impairments& impairments, std::size_t capacity) {
  checkImpairments(impairments);
  if (capacity == 0) throwBadValue("link capacity", capacity, "at least 1 packet");

  auto there = std::make_shared<Channel>(impairments, Direction::kForward, capacity);
  auto back = std::make_shared<Channel>(impairments, Direction::kBack, capacity);
  return {std::make_unique<SimulatedEnd>(there, back), std::make_unique<SimulatedEnd>(back, there)};
}

}  // namespace tandem
