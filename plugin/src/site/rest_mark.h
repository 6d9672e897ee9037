#pragma once

#include <cstdint>
#include <limits>

#include "coordination/src/island/island.h"

namespace tandem {

/// Marks a moment at which an island slept, and tells later whether anything has changed since. A
/// changed state wakes the island, and it can only sleep again after an advance that raises its
/// revision.
class RestMark {
 public:
  /// Marks the present if the island sleeps; otherwise clears the mark.
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
