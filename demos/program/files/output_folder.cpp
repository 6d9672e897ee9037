#include "files/output_folder.h"

#include <fstream>
#include <system_error>

#include "tandem/coordination/types.h"

#include "terminal/usage_error.h"

namespace tandem::demos {

void prepareFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const std::filesystem::path trial = folder / ".tandem-trial";
  const bool works = !error && std::ofstream(trial).put('x').good();
  std::filesystem::remove(trial, error);
  if (!works)
    throw UsageError("--out " + folder.string() +
                     ": cannot make files in this folder; choose one that is writable");
}

void writeText(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream)
    throw Error("cannot write " + file.string() + ": is the folder there, writable and not full?");
}

}  // namespace tandem::demos
