#pragma once

#include <filesystem>
#include <string>

namespace tandem::view {

/// The file of a world: a scenario file as written, or one of Tandem's own worlds by its name, such
/// as "crate" or "experiment1". Throws UsageError with the names that there are.
[[nodiscard]] std::filesystem::path findWorld(const std::string& argument);

}  // namespace tandem::view
