#pragma once

#include <filesystem>
#include <string>

namespace tandem::demos {

/// The bytes of a .bullet file whose header and chain of chunks are sound. The content of chunks is
/// not checked. Throws UsageError.
[[nodiscard]] std::string readBulletFile(const std::filesystem::path& file);

}  // namespace tandem::demos
