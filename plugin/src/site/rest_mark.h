#pragma once

#include <cstdint>
#include <limits>

#include "coordination/src/island/island.h"

namespace tandem {

/// A moment at which an island slept, to know later that nothing of it has changed since.
///
/// Whatever changes a state wakes the island, and a woken island does not sleep again without an
/// advance that has something to do; those are counted.
class RestMark {
 public:
  /// Now, if the island is asleep; else never.
  void set(const Island& island) noexcept {
    busy_advances_ = island.isAsleep() ? countBusyAdvances(island) : kNever;
  }
  void clear() noexcept { busy_advances_ = kNever; }
  [[nodiscard]] bool holds(const Island& island) const noexcept {
    return island.isAsleep() && countBusyAdvances(island) == busy_advances_;
  }

 private:
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

  static std::uint64_t countBusyAdvances(const Island& island) noexcept {
    return island.counters().advances - island.counters().asleep;
  }

  std::uint64_t busy_advances_ = kNever;
};

}  // namespace tandem
