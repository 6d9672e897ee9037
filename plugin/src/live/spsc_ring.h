#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

namespace tandem {

/// Queue from one thread to another with fixed capacity. Wait-free; allocates only at construction.
template <typename Value>
class SpscRing {
 public:
  explicit SpscRing(std::size_t capacity) : places_(capacity + 1) {}

  /// Appends a value. Returns false if the queue is full. For the one writing thread.
  bool push(const Value& value) noexcept {
    const std::size_t at = end_.load(std::memory_order_relaxed), next = follow(at);
    if (next == begin_.load(std::memory_order_acquire)) return false;
    places_[at] = value;
    end_.store(next, std::memory_order_release);
    return true;
  }

  /// Returns the oldest value, null if there is none; it stays until drop(). For the one reading
  /// thread.
  [[nodiscard]] const Value* peek() const noexcept {
    const std::size_t at = begin_.load(std::memory_order_relaxed);
    return at == end_.load(std::memory_order_acquire) ? nullptr : &places_[at];
  }
  void drop() noexcept {
    begin_.store(follow(begin_.load(std::memory_order_relaxed)), std::memory_order_release);
  }

 private:
  [[nodiscard]] std::size_t follow(std::size_t place) const noexcept {
    return place + 1 == places_.size() ? 0 : place + 1;
  }

  std::vector<Value> places_;
  alignas(64) std::atomic<std::size_t> begin_{0};
  alignas(64) std::atomic<std::size_t> end_{0};
};

}  // namespace tandem
