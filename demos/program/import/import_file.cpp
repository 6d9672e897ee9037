#include "import/import_file.h"

#include <cstdint>
#include <fstream>
#include <sstream>

#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

constexpr std::uintmax_t kLargest = 64u << 20;  // [byte]

}  // namespace

void checkImportFile(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    throw UsageError(file.string() + ": there is no such file; its path is from the scenario");
  if (std::filesystem::file_size(file, error) > kLargest)
    throw UsageError(file.string() + ": is larger than 64 MiB; simplify its meshes");
}

std::string readImportFile(const std::filesystem::path& file) {
  checkImportFile(file);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw UsageError(file.string() + ": cannot read this file; may you?");
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return bytes.str();
}

}  // namespace tandem::demos
