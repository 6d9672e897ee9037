#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

/// \file
/// Checks of TOML texts before a parser sees them. Files come from strangers, and a parser follows
/// levels by recursion, so a deep text would end the process.
#pragma GCC visibility push(default)
namespace tandem {

/// Largest TOML file [bytes].
inline constexpr std::size_t kLargestToml = std::size_t{1} << 20;

/// Most levels of tables, arrays and parts of dotted keys in a TOML text.
inline constexpr int kDeepestToml = 64;

/// Reads a TOML file: a regular file of at most kLargestToml with at most kDeepestToml levels.
/// `kind` names its expected content. Throws std::invalid_argument "FILE: fault; remedy" otherwise.
/// Does not wait for a pipe.
[[nodiscard]] std::string readTomlText(const std::filesystem::path& file, const std::string& kind);

/// Throws std::invalid_argument with `name` and the line if `text` has more than kDeepestToml
/// levels.
void requireShallowToml(std::string_view text, const std::string& name);

/// Line of a TOML text that first has more than `most` levels; nothing if none has. Each part of a
/// key is a level, each array is one, and `[[header]]` is one more for its array. Any text is safe.
[[nodiscard]] std::optional<int> findDeepToml(std::string_view text, int most = kDeepestToml);

}  // namespace tandem
#pragma GCC visibility pop
