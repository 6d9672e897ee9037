#pragma once

#include <string>

namespace tandem::demos {

/// "[###     ]": `value` from 0 to `most` in `width` places. A larger value fills it.
[[nodiscard]] std::string makeLevel(double value, double most, int width);

/// "[   |##  ]": `value` from -most to most around a middle, `width` places to each side.
[[nodiscard]] std::string makeBar(double value, double most, int width);

/// "##########" of `width` places for share 1; at least one for a share above 0.
[[nodiscard]] std::string makeShare(double share, int width);

}  // namespace tandem::demos
