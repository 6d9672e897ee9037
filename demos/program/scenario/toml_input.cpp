#include "scenario/toml_input.h"

#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "tandem/plugin/toml_text.h"

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

std::string describePlace(const Place& place, const toml::node& node) {
  // Only values of a file have a line; those of --set and of tests have no path.
  const bool has_line = node.source().path && node.source().begin.line > 0;
  return has_line ? fmt::format("{}:{}: {}", place.file, node.source().begin.line, place.key)
                  : fmt::format("{}: {}", place.file, place.key);
}

void refuse(const Place& place, const toml::node& node, const std::string& allowed) {
  throw UsageError(
      fmt::format("{} = {}: must be {}", describePlace(place, node), show(node), allowed));
}

toml::table parseToml(const std::string& text, const std::string& name) {
  try {
    requireShallowToml(text, name);
    return toml::parse(text, name);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  } catch (const toml::parse_error& error) {
    throw UsageError(
        fmt::format("{}:{}: not TOML: {}", name, error.source().begin.line, error.description()));
  }
}

std::string readText(const std::filesystem::path& file, const std::string& kind) {
  try {
    return readTomlText(file, kind);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

}  // namespace tandem::demos
