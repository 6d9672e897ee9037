#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

namespace tandem {

/// Lets other threads work on the island.
///
/// Without a haptic thread the island belongs to one thread, and requests run at once. With one,
/// only the haptic thread touches the island. It runs requests between two ticks, and the
/// requesting thread waits for at most a period. The haptic thread never waits: it checks one word
/// per tick.
class IslandDesk {
 public:
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

  /// Opens the desk before the haptic thread begins. Not for the haptic thread.
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

 private:
  struct Order {
    void (*call)(void*);
    void* work;
    std::atomic<bool> is_done{false};
  };
  static constexpr std::chrono::microseconds kPause{50};

  /// Withdraws a request. Returns true if it has not been started.
  bool takeBack(Order& order) noexcept {
    Order* expected = &order;
    return order_.compare_exchange_strong(expected, nullptr, std::memory_order_acquire);
  }

  std::atomic<bool> is_open_{false};
  std::atomic<bool> was_ever_open_{false};  ///< from then on several threads may call run()
  std::atomic<Order*> order_{nullptr};
  std::mutex asking_;
};

}  // namespace tandem
