#pragma once

#include <filesystem>
#include <string>

#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

namespace tandem::demos {

/// Place of a value, for messages.
struct Place {
  std::string file;
  std::string key;
};

/// The value in one line of at most 60 characters.
[[nodiscard]] std::string show(const toml::node& node);

/// "<file>:<line>: <key>", without the line where there is none.
[[nodiscard]] std::string describePlace(const Place& place, const toml::node& node);

/// Throws UsageError "<file>:<line>: <key> = <value>: must be <allowed>".
[[noreturn]] void refuse(const Place& place, const toml::node& node, const std::string& allowed);

/// Parses a TOML text. Throws UsageError with `name` and the line if it is invalid or nests too
/// deep.
[[nodiscard]] toml::table parseToml(const std::string& text, const std::string& name);

/// Reads a TOML file as readTomlText does; `kind` names its expected content. Throws UsageError.
[[nodiscard]] std::string readText(const std::filesystem::path& file, const std::string& kind);

}  // namespace tandem::demos
