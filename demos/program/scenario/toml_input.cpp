#include "scenario/toml_input.h"

#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "terminal/usage_error.h"

namespace tandem::demos {

std::string show(const toml::node& node) {
  std::ostringstream text;
  node.visit([&](const auto& value) { text << value; });
  std::string line = text.str();
  for (char& c : line)
    if (c == '\n') c = ' ';
  return line.size() > 60 ? line.substr(0, 57) + "..." : line;
}

void refuse(const Place& place, const toml::node& node, const std::string& allowed) {
  throw UsageError(
      fmt::format("{}: {} = {}: must be {}", place.file, place.key, show(node), allowed));
}

toml::table parseToml(const std::string& text, const std::string& name) {
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    throw UsageError(
        fmt::format("{}:{}: not TOML: {}", name, error.source().begin.line, error.description()));
  }
}

std::string readText(const std::filesystem::path& file, const std::string& kind) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (stream) text << stream.rdbuf();
  if (!stream || std::filesystem::is_directory(file))
    throw UsageError(file.string() + ": cannot read this " + kind + "; is the path right?");
  return text.str();
}

}  // namespace tandem::demos
