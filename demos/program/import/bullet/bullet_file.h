#pragma once

#include <filesystem>
#include <vector>

namespace tandem::demos {

/// The bytes of a .bullet file whose header and chain of chunks are sound. What chunks hold is not
/// checked. Throws UsageError.
[[nodiscard]] std::vector<char> readBulletFile(const std::filesystem::path& file);

}  // namespace tandem::demos
