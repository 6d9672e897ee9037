#pragma once

#include <cstddef>

namespace tandem::test {

/// Counts the mutexes that a thread asks for while it lives: pthread_mutex_lock() and all that ends
/// in it, std::mutex among them. It belongs to the thread that made it; one at a time.
class LockCount {
 public:
  LockCount();
  ~LockCount();
  LockCount(const LockCount&) = delete;
  LockCount& operator=(const LockCount&) = delete;

  [[nodiscard]] std::size_t count() const noexcept;
};

}  // namespace tandem::test
