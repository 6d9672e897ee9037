#pragma once

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <ctime>
#include <mutex>
#include <thread>

#include <semaphore.h>

#include "tandem/falcon/monotonic_clock.h"

namespace tandem {

/// Lets other threads work on the island.
///
/// Without a haptic thread the island belongs to one thread, and requests run at once. With one,
/// only the haptic thread touches the island. It runs requests between two ticks, and the
/// requesting thread waits for a tick and a quarter of a millisecond at most. The haptic thread
/// never waits: a request wakes it while it sleeps.
class IslandDesk {
 public:
  IslandDesk() noexcept { sem_init(&asked_, 0, 0); }
  ~IslandDesk() { sem_destroy(&asked_); }
  IslandDesk(const IslandDesk&) = delete;
  IslandDesk& operator=(const IslandDesk&) = delete;

  /// Runs `work` on the island. For any thread but the haptic one. `work` must not throw, wait or
  /// call run().
  template <typename Work>
  void run(Work&& work) {
    if (!was_ever_open_.load(std::memory_order_acquire)) return work();
    const std::lock_guard one_at_a_time(asking_);
    if (!is_open_.load(std::memory_order_acquire)) return work();
    auto call = [&work] { work(); };
    Order order{[](void* it) { (*static_cast<decltype(call)*>(it))(); }, &call, {}};
    order_.store(&order, std::memory_order_release);
    sem_post(&asked_);
    while (!order.is_done.load(std::memory_order_acquire)) {
      if (!is_open_.load(std::memory_order_acquire) && takeBack(order)) return work();
      std::this_thread::sleep_for(kPause);
    }
  }

  [[nodiscard]] bool isOpen() const noexcept { return is_open_.load(std::memory_order_acquire); }
  /// True once a haptic thread has begun, also when it has left.
  [[nodiscard]] bool wasEverOpen() const noexcept {
    return was_ever_open_.load(std::memory_order_acquire);
  }

  /// Opens a desk that is closed, before the haptic thread begins. It waits for work that runs, so
  /// that an open desk would wait for a request that only its own thread serves.
  void open() {
    was_ever_open_.store(true, std::memory_order_release);
    const std::lock_guard one_at_a_time(asking_);
    is_open_.store(true, std::memory_order_release);
  }
  /// Closes the desk. The haptic thread calls it when it leaves the island.
  void close() noexcept { is_open_.store(false, std::memory_order_release); }

  /// Runs a waiting request between two ticks. For the haptic thread. Real-time safe.
  void serve() noexcept {
    Order* order = order_.exchange(nullptr, std::memory_order_acquire);
    if (!order) return;
    order->call(order->work);
    order->is_done.store(true, std::memory_order_release);
  }

  /// Sleeps until a moment of the monotonic clock [s], and runs requests that arrive meanwhile. The
  /// last part of the time stays free, so that they do not delay a tick. For the haptic thread.
  void serveUntil(double moment) noexcept {
    while (waitForRequest(moment - kFree)) serve();
    sleepUntil(moment);
  }

 private:
  struct Order {
    void (*call)(void*);
    void* work;
    std::atomic<bool> is_done{false};
  };
  static constexpr std::chrono::microseconds kPause{50};
  static constexpr double kFree = 2.5e-4;  ///< before a tick [s]

  /// False at the moment [s]. True may be a request that has been served already.
  bool waitForRequest(double moment) noexcept {
    if (!(moment > 0.0)) return false;
    const auto seconds = static_cast<time_t>(moment);
    const double rest = moment - static_cast<double>(seconds);
    const timespec until{seconds, std::min(static_cast<long>(rest * 1e9), 999'999'999L)};
    int result = 0;
    do {
      result = sem_clockwait(&asked_, CLOCK_MONOTONIC, &until);
    } while (result != 0 && errno == EINTR);
    return result == 0;
  }

  /// Withdraws a request. Returns true if it has not been started.
  bool takeBack(Order& order) noexcept {
    Order* expected = &order;
    return order_.compare_exchange_strong(expected, nullptr, std::memory_order_acquire);
  }

  std::atomic<bool> is_open_{false};
  std::atomic<bool> was_ever_open_{false};  ///< from then on several threads may call run()
  std::atomic<Order*> order_{nullptr};
  std::mutex asking_;
  sem_t asked_;  ///< posted for each request: wakes the haptic thread
};

}  // namespace tandem
