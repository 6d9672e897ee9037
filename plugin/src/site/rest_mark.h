#pragma once

#include <cstdint>
#include <limits>

#include "coordination/src/island/island.h"

namespace tandem {

/// A moment at which an island slept. It tells later whether anything has changed since: a changed
/// state wakes the island, and only an advance that raises its revision lets it sleep again.
class RestMark {
 public:
  /// Now, if the island is asleep; else never.
  void set(const Island& island) noexcept {
    revision_ = island.isAsleep() ? island.revision() : kNever;
  }
  void clear() noexcept { revision_ = kNever; }
  [[nodiscard]] bool holds(const Island& island) const noexcept {
    return island.isAsleep() && island.revision() == revision_;
  }

 private:
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

  std::uint64_t revision_ = kNever;
};

}  // namespace tandem
