#include "tandem/coordination/simulated_link.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bad_value.h"
#include "counter_random.h"

//   send(packet, now)                                             receive(from, until)
//        |                                                                ^
//      lost? ----> launch: now + delay +- jitter, or now if reordered     | earliest arrival <
//      until
//        |                                    \                           | that was sent < from
//        +-------> launch: the duplicate ------> heap of what is in flight
//
// The heap orders small entries; the packets stay in their slots from send() to receive().

namespace tandem {
namespace {

/// One random stream for each decision, so that no impairment shifts another's draws.
enum class Stream : std::uint64_t { kLoss, kDuplicate, kReorder, kJitter, kDuplicateJitter };

/// One direction of the way.
class Channel {
 public:
  Channel(const Impairments& impairments, std::uint64_t direction, std::size_t capacity)
      : impairments_(impairments), direction_(direction), packets_(capacity) {
    in_flight_.reserve(capacity);
    held_back_.reserve(capacity);
    free_slots_.resize(capacity);
    for (std::size_t slot = 0; slot < capacity; ++slot) free_slots_[slot] = slot;
  }

  void send(const StatePacket& packet, double now) noexcept {
    const std::uint64_t number = counts_.sent++;
    if (happens(Stream::kLoss, impairments_.loss, number)) {
      ++counts_.lost;
      return;
    }
    if (happens(Stream::kReorder, impairments_.reorder, number)) {
      ++counts_.reordered;
      launch(packet, now, now);
    } else {
      launch(packet, now, now + computeDelay(Stream::kJitter, number));
    }
    if (happens(Stream::kDuplicate, impairments_.duplicate, number)) {
      ++counts_.duplicated;
      launch(packet, now, now + computeDelay(Stream::kDuplicateJitter, number));
    }
  }

  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept {
    std::optional<Arrival> arrival;
    while (!arrival && !in_flight_.empty() && in_flight_.front().arrival < until) {
      const Flight flight = popEarliest();
      if (flight.sent < from) {
        arrival = Arrival{packets_[flight.slot], std::max(flight.arrival, from)};
        free_slots_.push_back(flight.slot);
        ++counts_.delivered;
      } else {
        held_back_.push_back(flight);  // sent in this very tick: a later one takes it in
      }
    }
    for (const Flight& flight : held_back_) push(flight);
    held_back_.clear();
    return arrival;
  }

  [[nodiscard]] const ChannelCounts& counts() const noexcept { return counts_; }

 private:
  struct Flight {
    double arrival = 0.0;     // [s]
    double sent = 0.0;        // [s]
    std::uint64_t order = 0;  // of sending; decides between equal arrivals
    std::size_t slot = 0;     // of the packet
  };

  // Standard heaps keep the greatest in front, and the earliest is wanted there.
  static bool isLater(const Flight& a, const Flight& b) noexcept {
    return a.arrival != b.arrival ? a.arrival > b.arrival : a.order > b.order;
  }

  [[nodiscard]] double draw(Stream stream, std::uint64_t number) const noexcept {
    return drawUniform(impairments_.seed, direction_, static_cast<std::uint64_t>(stream), number);
  }

  [[nodiscard]] bool happens(Stream stream, double probability,
                             std::uint64_t number) const noexcept {
    return draw(stream, number) < probability;
  }

  [[nodiscard]] double computeDelay(Stream stream, std::uint64_t number) const noexcept {
    const double deviation = impairments_.jitter * (2.0 * draw(stream, number) - 1.0);
    return std::max(0.0, impairments_.delay + deviation);
  }

  void launch(const StatePacket& packet, double sent, double arrival) noexcept {
    if (free_slots_.empty()) {
      ++counts_.overflowed;
      return;
    }
    const std::size_t slot = free_slots_.back();
    free_slots_.pop_back();
    packets_[slot] = packet;
    push({arrival, sent, launched_++, slot});
  }

  // All four vectors have their full capacity from the start: pushing never allocates.
  void push(const Flight& flight) noexcept {
    in_flight_.push_back(flight);
    std::push_heap(in_flight_.begin(), in_flight_.end(), isLater);
  }

  [[nodiscard]] Flight popEarliest() noexcept {
    std::pop_heap(in_flight_.begin(), in_flight_.end(), isLater);
    const Flight earliest = in_flight_.back();
    in_flight_.pop_back();
    return earliest;
  }

  Impairments impairments_;
  std::uint64_t direction_;
  ChannelCounts counts_;
  std::uint64_t launched_ = 0;
  std::vector<Flight> in_flight_;  // heap
  std::vector<Flight> held_back_;  // empty between calls
  std::vector<StatePacket> packets_;
  std::vector<std::size_t> free_slots_;
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
  // Shared by both ends, so that either may go first.
  std::shared_ptr<Channel> outgoing_;
  std::shared_ptr<Channel> incoming_;
};

void checkTime(const char* name, double value) {
  if (!(std::isfinite(value) && value >= 0.0))
    throwBadValue(name, value, "finite and not below 0 s");
}

void checkProbability(const char* name, double value) {
  if (!(value >= 0.0 && value <= 1.0)) throwBadValue(name, value, "a probability from 0 to 1");
}

}  // namespace

std::pair<std::unique_ptr<SimulatedLink>, std::unique_ptr<SimulatedLink>> makeSimulatedLinks(
    const Impairments& impairments, std::size_t capacity) {
  checkTime("network delay", impairments.delay);
  checkTime("network jitter", impairments.jitter);
  checkProbability("network loss", impairments.loss);
  checkProbability("network duplicate", impairments.duplicate);
  checkProbability("network reorder", impairments.reorder);
  if (capacity == 0) throwBadValue("link capacity", capacity, "at least 1 packet");

  auto there = std::make_shared<Channel>(impairments, 0, capacity);
  auto back = std::make_shared<Channel>(impairments, 1, capacity);
  return {std::make_unique<SimulatedEnd>(there, back), std::make_unique<SimulatedEnd>(back, there)};
}

}  // namespace tandem
