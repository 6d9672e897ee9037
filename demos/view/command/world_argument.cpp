#include "command/world_argument.h"

#include <algorithm>
#include <vector>

#include <fmt/ranges.h>

#include "terminal/usage_error.h"

namespace tandem::view {
namespace {

namespace fs = std::filesystem;

/// The worlds are beside the program in a build folder, and below share/ in an installation.
fs::path findWorlds() {
  std::error_code ignored;
  const fs::path here = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  for (const char* place : {"worlds", TANDEM_DATA_FROM_PROGRAM "/worlds"})
    if (fs::is_directory(here / place, ignored)) return here / place;
  return {};
}

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
  const fs::path folder = findWorlds();
  std::error_code ignored;
  const fs::path own = folder / (argument + ".toml");
  const bool is_name = argument.find('/') == std::string::npos;
  if (is_name && fs::is_regular_file(own, ignored)) return own;
  if (fs::exists(argument, ignored)) return argument;
  throw demos::UsageError(fmt::format("{}: there is no such file or world; worlds: {}", argument,
                                      fmt::join(listWorlds(folder), ", ")));
}

}  // namespace tandem::view
