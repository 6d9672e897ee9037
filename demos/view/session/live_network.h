#pragma once

#include <memory>
#include <mutex>
#include <thread>

#include "tandem/coordination/simulated_link.h"
#include "tandem/plugin/link_queue.h"

namespace tandem::view {

/// A simulated network between two sites of one process. While they tick in threads of their own, a
/// third thread carries the packets.
class LiveNetwork {
 public:
  /// Throws std::invalid_argument for impairments out of range.
  explicit LiveNetwork(const Impairments& network);
  LiveNetwork(const LiveNetwork&) = delete;
  LiveNetwork& operator=(const LiveNetwork&) = delete;

  /// End of a site, 0 or 1; for the thread that ticks it.
  [[nodiscard]] Link& end(int site) noexcept { return queues_[site]; }

  /// Starts to carry packets. The sites' time is the monotonic clock's less `begin` [s].
  void start(double begin);
  /// Stops to carry packets. Those on the way wait.
  void stop() noexcept { thread_ = {}; }
  /// Carries the packets that are due when the sites' time is `now` [s]: without start(), before
  /// each tick.
  void carry(double now);
  /// From now on the network is another. Packets on the way are lost. For any thread. Throws as the
  /// constructor does; then the network stays.
  void change(const Impairments& network);

 private:
  using Ends = std::pair<std::unique_ptr<SimulatedLink>, std::unique_ptr<SimulatedLink>>;

  LinkQueue queues_[2];
  std::mutex mutex_;  // of ends_
  Ends ends_;
  std::jthread thread_;  // the last: it ends before what it uses
};

}  // namespace tandem::view
