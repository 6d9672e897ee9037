#pragma once

#include <cstddef>

namespace tandem::test {

/// Counts what is taken from the heap while it lives: operator new in all its forms, malloc and its
/// relatives in everything that is linked statically, and Bullet's btAlignedAlloc.
///
/// It counts what the thread takes that made it, and belongs to that thread; one at a time. The
/// first few allocations are shown on standard error with their call stack, unless `shows` is
/// false.
class AllocationCount {
 public:
  explicit AllocationCount(bool shows = true);
  ~AllocationCount();
  AllocationCount(const AllocationCount&) = delete;
  AllocationCount& operator=(const AllocationCount&) = delete;

  [[nodiscard]] std::size_t count() const noexcept;

  /// Bullet's allocations come here from now on; before any Bullet object is made.
  static void watchBullet();
};

}  // namespace tandem::test
