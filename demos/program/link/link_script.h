#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tandem/coordination/link_plan.h"

namespace tandem::demos {

/// Reads the changes of a script in TOML:
///
///     [[change]]
///     at = 5.0            # seconds after the start
///     delay = "100ms"
///     outage = true
///
/// docs/network.md lists all keys. `name` appears in messages. Throws UsageError, one line with
/// file, key, value and the allowed values.
[[nodiscard]] std::vector<LinkChange> parseLinkScript(const std::string& text,
                                                      const std::string& name);

/// The same from a file.
[[nodiscard]] std::vector<LinkChange> loadLinkScript(const std::filesystem::path& file);

}  // namespace tandem::demos
