#pragma once

#include <filesystem>
#include <string>

namespace tandem::demos {

/// Makes the folder of --out if needed, and checks that it is writable. Throws UsageError.
void prepareFolder(const std::filesystem::path& folder);

/// Stores `text` as a file. Throws Error with the file's name.
void writeText(const std::filesystem::path& file, const std::string& text);

}  // namespace tandem::demos
