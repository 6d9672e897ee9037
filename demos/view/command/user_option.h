#pragma once

#include <optional>

#include <fmt/format.h>

#include "terminal/usage_error.h"

namespace tandem::view {

/// The user, 0 or 1, whose view of a recorded run --site asks for; 0 there asks for none. Throws
/// UsageError.
[[nodiscard]] inline std::optional<int> chooseUser(int site) {
  if (site == 0) return std::nullopt;
  if (site != 1 && site != 2)
    throw demos::UsageError(fmt::format("--site {}: must be 1 or 2", site));
  return site - 1;
}

}  // namespace tandem::view
