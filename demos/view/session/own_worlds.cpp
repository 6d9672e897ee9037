#include "session/own_worlds.h"

#include <algorithm>

#include "files/own_folder.h"

namespace tandem::view {
namespace {

namespace fs = std::filesystem;

/// The paper's experiments are scenarios.
std::vector<fs::path> ownFolders() {
  return {demos::findOwnData("worlds"), demos::findOwnData("scenarios")};
}

}  // namespace

std::vector<std::string> listWorlds() {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const fs::path& folder : ownFolders())
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
      if (entry.path().extension() == ".toml") names.push_back(entry.path().stem());
  std::ranges::sort(names);
  return names;
}

std::optional<fs::path> findOwnWorld(const std::string& name) {
  std::error_code ignored;
  if (name.find('/') != std::string::npos) return std::nullopt;
  for (const fs::path& folder : ownFolders())
    if (fs::path file = folder / (name + ".toml"); fs::is_regular_file(file, ignored)) return file;
  return std::nullopt;
}

}  // namespace tandem::view
