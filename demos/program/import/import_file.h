#pragma once

#include <filesystem>
#include <string>

namespace tandem::demos {

/// Throws UsageError unless there is a file of at most 64 MiB.
void checkImportFile(const std::filesystem::path& file);

/// The bytes of such a file. Throws UsageError, also if this process may not read it.
[[nodiscard]] std::string readImportFile(const std::filesystem::path& file);

}  // namespace tandem::demos
