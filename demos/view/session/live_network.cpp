#include "session/live_network.h"

#include "tandem/falcon/monotonic_clock.h"

namespace tandem::view {
namespace {

/// A site wants its packets two periods ahead, twice a period [s].
constexpr double kPause = 0.5e-3, kAhead = 2e-3;

}  // namespace

LiveNetwork::LiveNetwork(const Impairments& network) : ends_(makeSimulatedLinks(network)) {}

void LiveNetwork::start(double begin) {
  thread_ = std::jthread([this, begin](const std::stop_token& stop) {
    for (; !stop.stop_requested(); sleepFor(kPause)) carry(readMonotonicClock() - begin);
  });
}

void LiveNetwork::carry(double now) {
  const std::lock_guard lock(mutex_);
  queues_[0].exchange(*ends_.first, now, now + kAhead);
  queues_[1].exchange(*ends_.second, now, now + kAhead);
}

void LiveNetwork::change(const Impairments& network) {
  Ends ends = makeSimulatedLinks(network);
  const std::lock_guard lock(mutex_);
  ends_.swap(ends);
}

}  // namespace tandem::view
