#pragma once

#include <cstddef>

namespace tandem::test {

/// Counts the mutexes that a thread locks while this lives: pthread_mutex_lock() and all that call
/// it, including std::mutex. It belongs to the thread that made it; one at a time.
class LockCount {
 public:
  LockCount();
  ~LockCount();
  LockCount(const LockCount&) = delete;
  LockCount& operator=(const LockCount&) = delete;

  [[nodiscard]] std::size_t count() const noexcept;
};

}  // namespace tandem::test
