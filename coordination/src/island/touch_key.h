#pragma once

#include <cstdint>

#include "island/contact_finder.h"

namespace tandem {

/// A sphere and the thing that it touches, the same from tick to tick.
struct TouchKey {
  BodyIndex sphere = 0;
  BodyIndex other = 0;         ///< the sphere itself with an obstacle
  std::uint64_t obstacle = 0;  ///< 0: `other` is a body
  int part = 0;                ///< of a compound, from 1; 0: the whole shape

  /// True for any part of the same thing.
  [[nodiscard]] bool isOf(const TouchKey& whole) const noexcept {
    return sphere == whole.sphere && other == whole.other && obstacle == whole.obstacle;
  }

  bool operator==(const TouchKey&) const = default;
};

}  // namespace tandem
