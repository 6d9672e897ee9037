#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

namespace tandem {

/// Where other threads ask for the island.
///
/// Before there is a haptic thread the island belongs to one thread, and what is asked is done at
/// once. While there is one, it alone touches the island: it does what is asked between two of its
/// ticks, and whoever asked waits for that, a period at the most. The haptic thread never waits: it
/// looks at one word, and what it finds there is done or is not there.
class IslandDesk {
 public:
  /// From any thread but the haptic one. `work` must not throw, wait or ask again.
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

  /// Before the haptic thread begins; not by itself.
  void open() {
    was_ever_open_.store(true, std::memory_order_release);
    const std::lock_guard one_at_a_time(asking_);
    is_open_.store(true, std::memory_order_release);
  }
  /// By the haptic thread, which does not touch the island any more.
  void close() noexcept { is_open_.store(false, std::memory_order_release); }

  /// By the haptic thread, between two ticks. Real-time safe.
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

  /// True if nobody has begun with it.
  bool takeBack(Order& order) noexcept {
    Order* expected = &order;
    return order_.compare_exchange_strong(expected, nullptr, std::memory_order_acquire);
  }

  std::atomic<bool> is_open_{false};
  std::atomic<bool> was_ever_open_{false};  ///< since then several threads may ask
  std::atomic<Order*> order_{nullptr};
  std::mutex asking_;
};

}  // namespace tandem
