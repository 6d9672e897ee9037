#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace tandem {

/// Copies under way, ordered by arrival. The heap holds small entries; the contents stay in the
/// caller's slots from launch() to release(). Only the constructor allocates.
class FlightQueue {
 public:
  struct Flight {
    double arrival = 0.0;     ///< [s]
    double sent = 0.0;        ///< [s]
    std::uint64_t order = 0;  ///< number of the launch; decides between equal arrivals
    std::size_t slot = 0;     ///< 0 to capacity - 1
  };

  explicit FlightQueue(std::size_t capacity) : free_slots_(capacity) {
    flights_.reserve(capacity);
    for (std::size_t slot = 0; slot < capacity; ++slot) free_slots_[slot] = slot;
  }

  /// The slot of the new flight; nothing if all slots are taken.
  [[nodiscard]] std::optional<std::size_t> launch(double sent, double arrival) noexcept {
    if (free_slots_.empty()) return std::nullopt;
    const std::size_t slot = free_slots_.back();
    free_slots_.pop_back();
    putBack({arrival, sent, launched_++, slot});
    return slot;
  }

  [[nodiscard]] bool isEmpty() const noexcept { return flights_.empty(); }
  [[nodiscard]] const Flight& earliest() const noexcept { return flights_.front(); }

  /// Ends the earliest flight; its slot stays taken until release().
  [[nodiscard]] Flight takeEarliest() noexcept {
    std::pop_heap(flights_.begin(), flights_.end(), isLater);
    const Flight earliest = flights_.back();
    flights_.pop_back();
    return earliest;
  }

  /// Puts a taken flight back into the queue.
  void putBack(const Flight& flight) noexcept {
    flights_.push_back(flight);
    std::push_heap(flights_.begin(), flights_.end(), isLater);
  }

  void release(std::size_t slot) noexcept { free_slots_.push_back(slot); }

 private:
  // Standard heaps keep the greatest element in front; this puts the earliest there.
  static bool isLater(const Flight& a, const Flight& b) noexcept {
    return a.arrival != b.arrival ? a.arrival > b.arrival : a.order > b.order;
  }

  std::uint64_t launched_ = 0;
  std::vector<Flight> flights_;  // heap
  std::vector<std::size_t> free_slots_;
};

}  // namespace tandem
