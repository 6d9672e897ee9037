#pragma once

#include <filesystem>
#include <string>

#include <fmt/format.h>

#include "terminal/usage_error.h"

namespace tandem::view {

/// Throws UsageError: what is wrong at a place of a recorded run, and the remedy.
[[noreturn]] inline void refuseRunFile(const std::filesystem::path& place,
                                       const std::string& problem) {
  throw demos::UsageError(
      fmt::format("{}: {}; give a folder that `tandem run --out`, `tandem peer --out` or `tandem "
                  "view --record` "
                  "of this release wrote",
                  place.string(), problem));
}

}  // namespace tandem::view
