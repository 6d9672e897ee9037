#include "tandem/plugin/link_queue.h"

#include <algorithm>
#include <atomic>

#include "live/spsc_ring.h"

namespace tandem {
namespace {

/// Capacity each way: half a second of packets at 1 kHz.
constexpr std::size_t kRoom = 512;

}  // namespace

struct LinkQueue::Impl {
  struct Departure {
    StatePacket packet;
    double time = 0.0;
  };
  SpscRing<Departure> departures{kRoom};
  SpscRing<Arrival> arrivals{kRoom};
  std::atomic<std::uint64_t> lost{0};
  std::atomic<bool> has_left{false};

  void count(bool found_room) noexcept {
    if (!found_room) lost.fetch_add(1, std::memory_order_relaxed);
  }
};

LinkQueue::LinkQueue() : impl_(std::make_unique<Impl>()) {}
LinkQueue::~LinkQueue() = default;

void LinkQueue::send(const StatePacket& packet, double now) noexcept {
  impl_->count(impl_->departures.push({packet, now}));
}

std::optional<Arrival> LinkQueue::receive(double from, double until) noexcept {
  const Arrival* next = impl_->arrivals.peek();
  if (!next || next->time >= until) return std::nullopt;
  Arrival arrival = *next;
  impl_->arrivals.drop();
  arrival.time = std::max(arrival.time, from);
  return arrival;
}

void LinkQueue::exchange(Link& link, double now, double until) noexcept {
  while (const Impl::Departure* next = impl_->departures.peek()) {
    link.send(next->packet, next->time);
    impl_->departures.drop();
  }
  while (const auto arrival = link.receive(now, until))
    impl_->count(impl_->arrivals.push(*arrival));
  impl_->has_left.store(link.hasLeft(), std::memory_order_relaxed);
}

bool LinkQueue::hasLeft() const noexcept { return impl_->has_left.load(std::memory_order_relaxed); }

std::uint64_t LinkQueue::lost() const noexcept {
  return impl_->lost.load(std::memory_order_relaxed);
}

}  // namespace tandem
