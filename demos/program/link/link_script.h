#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tandem/coordination/link_plan.h"

namespace tandem::demos {

/// The changes of a script, in TOML:
///
///     [[change]]
///     at = 5.0            # seconds after the start
///     delay = "100ms"
///     outage = true
///
/// All keys are in docs/network.md. `name` stands in messages. Throws UsageError, one line with
/// file, key, value and what is allowed.
[[nodiscard]] std::vector<LinkChange> parseLinkScript(const std::string& text,
                                                      const std::string& name);

/// The same from a file.
[[nodiscard]] std::vector<LinkChange> loadLinkScript(const std::filesystem::path& file);

}  // namespace tandem::demos
