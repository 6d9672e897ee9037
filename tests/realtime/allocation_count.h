#pragma once

#include <cstddef>

namespace tandem::test {

/// Counts heap allocations while it lives: operator new in all forms, malloc and its relatives in
/// statically linked code, and Bullet's btAlignedAlloc.
///
/// It counts the thread that made it, and belongs to that thread; one at a time. The first few
/// allocations are shown on standard error with their call stack, unless `shows` is false.
class AllocationCount {
 public:
  explicit AllocationCount(bool shows = true);
  ~AllocationCount();
  AllocationCount(const AllocationCount&) = delete;
  AllocationCount& operator=(const AllocationCount&) = delete;

  [[nodiscard]] std::size_t count() const noexcept;

  /// Redirects Bullet's allocations here from now on. Call it before making any Bullet object.
  static void watchBullet();
};

}  // namespace tandem::test
