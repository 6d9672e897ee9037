#include "command/world_argument.h"

#include <algorithm>
#include <vector>

#include <fmt/ranges.h>

#include "files/own_folder.h"
#include "terminal/usage_error.h"

namespace tandem::view {
namespace {

namespace fs = std::filesystem;

/// Folders of Tandem's own worlds. The paper's experiments are scenarios.
std::vector<fs::path> ownFolders() {
  return {demos::findOwnData("worlds"), demos::findOwnData("scenarios")};
}

std::vector<std::string> listWorlds() {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const fs::path& folder : ownFolders())
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
      if (entry.path().extension() == ".toml") names.push_back(entry.path().stem());
  std::ranges::sort(names);
  return names;
}

}  // namespace

fs::path findWorld(const std::string& argument) {
  std::error_code ignored;
  if (argument.find('/') == std::string::npos)
    for (const fs::path& folder : ownFolders())
      if (const fs::path own = folder / (argument + ".toml"); fs::is_regular_file(own, ignored))
        return own;
  if (fs::exists(argument, ignored)) return argument;
  throw demos::UsageError(fmt::format("{}: there is no such file or world; worlds: {}", argument,
                                      fmt::join(listWorlds(), ", ")));
}

}  // namespace tandem::view
