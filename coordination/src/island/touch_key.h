#pragma once

#include <cstdint>

#include "island/contact_finder.h"

namespace tandem {

/// A sphere and the thing that it touches, the same from tick to tick.
struct TouchKey {
  BodyIndex sphere = 0;
  BodyIndex other = 0;         ///< the sphere itself with an obstacle
  std::uint64_t obstacle = 0;  ///< 0: `other` is a body

  bool operator==(const TouchKey&) const = default;
};

}  // namespace tandem
