#pragma once

#include <filesystem>
#include <string>

#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

namespace tandem::demos {

/// Where a value stands, for messages.
struct Place {
  std::string file;
  std::string key;
};

/// The value in one line of at most 60 characters.
[[nodiscard]] std::string show(const toml::node& node);

/// Throws UsageError "<file>: <key> = <value>: must be <allowed>".
[[noreturn]] void refuse(const Place& place, const toml::node& node, const std::string& allowed);

/// The table of a TOML text. Throws UsageError with `name` and the line if it is none.
[[nodiscard]] toml::table parseToml(const std::string& text, const std::string& name);

/// All of a file; `kind` says what it should be. Throws UsageError if it cannot be read.
[[nodiscard]] std::string readText(const std::filesystem::path& file, const std::string& kind);

}  // namespace tandem::demos
