#pragma once

#include <optional>

#include <fmt/format.h>

#include "scenario/site_scenario.h"
#include "terminal/usage_error.h"

namespace tandem::view {

/// The user, from 0, whose view of a recorded run --site asks for; 0 there asks for none. Throws
/// UsageError.
[[nodiscard]] inline std::optional<int> chooseUser(int site) {
  if (site == 0) return std::nullopt;
  if (site < 1 || site > static_cast<int>(demos::kMostSites))
    throw demos::UsageError(
        fmt::format("--site {}: must be 1 or 2, or that of another site of the run", site));
  return site - 1;
}

}  // namespace tandem::view
