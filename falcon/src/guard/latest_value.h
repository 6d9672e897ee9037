#pragma once

#include <array>
#include <atomic>
#include <type_traits>

namespace tandem {

/// Passes the newest value from one thread to another. There are three slots: the writer owns one,
/// the reader owns one, and the third is exchanged. No side waits, no value is torn, and older
/// values are lost. One thread writes, one reads. Wait-free and real-time safe on both sides.
template <typename Value>
class LatestValue {
 public:
  static_assert(std::is_nothrow_copy_assignable_v<Value>);

  explicit LatestValue(const Value& first = {}) noexcept { rooms_.fill(first); }

  void write(const Value& value) noexcept {
    rooms_[writers_] = value;
    writers_ = between_.exchange(writers_ | kIsNew, std::memory_order_acq_rel) & kRoom;
  }

  /// Returns the newest value; the same one again until a newer one is written.
  [[nodiscard]] const Value& read() noexcept {
    if (between_.load(std::memory_order_relaxed) & kIsNew)
      readers_ = between_.exchange(readers_, std::memory_order_acq_rel) & kRoom;
    return rooms_[readers_];
  }

  /// True if read() would return a new value. For the reader.
  [[nodiscard]] bool isNew() const noexcept {
    return between_.load(std::memory_order_relaxed) & kIsNew;
  }

 private:
  static constexpr unsigned kRoom = 3, kIsNew = 4;

  std::array<Value, 3> rooms_;
  std::atomic<unsigned> between_{0};
  unsigned writers_ = 1, readers_ = 2;
};

}  // namespace tandem
