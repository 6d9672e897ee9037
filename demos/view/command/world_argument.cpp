#include "command/world_argument.h"

#include <algorithm>
#include <vector>

#include <fmt/ranges.h>

#include "files/own_folder.h"
#include "terminal/usage_error.h"

namespace tandem::view {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> listWorlds(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem());
  std::ranges::sort(names);
  return names;
}

}  // namespace

fs::path findWorld(const std::string& argument) {
  const fs::path folder = demos::findOwnData("worlds");
  std::error_code ignored;
  const fs::path own = folder / (argument + ".toml");
  const bool is_name = argument.find('/') == std::string::npos;
  if (is_name && fs::is_regular_file(own, ignored)) return own;
  if (fs::exists(argument, ignored)) return argument;
  throw demos::UsageError(fmt::format("{}: there is no such file or world; worlds: {}", argument,
                                      fmt::join(listWorlds(folder), ", ")));
}

}  // namespace tandem::view
