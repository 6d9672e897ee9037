#include "files/own_folder.h"

namespace tandem::demos {

namespace fs = std::filesystem;

fs::path findOwnFolder() {
  std::error_code ignored;
  return fs::read_symlink("/proc/self/exe", ignored).parent_path();
}

fs::path findOwnData(const std::string& name) {
  std::error_code ignored;
  const fs::path here = findOwnFolder();
  // A test's program is in a folder beside the one with the data.
  for (const char* place : {".", "../demos", TANDEM_DATA_FROM_PROGRAM})
    if (fs::exists(here / place / name, ignored)) return (here / place / name).lexically_normal();
  return {};
}

}  // namespace tandem::demos
