#include "files/output_folder.h"

#include <fstream>
#include <system_error>

#include "tandem/coordination/types.h"

#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

namespace fs = std::filesystem;

const fs::path& makeFolder(const fs::path& folder, const std::string& name) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder, error))
    throw UsageError(name + ": cannot make files here; choose a folder that is there and writable");
  return folder;
}

/// Each part has a place of its own for unfinished files.
std::string nameAside(FolderPart part) {
  const std::string name = ".tandem-unfinished";
  return part == FolderPart::kAll ? name : name + "-" + std::to_string(static_cast<int>(part));
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& folder, const std::string& name, FolderPart part)
    : folder_(makeFolder(folder, name)),
      aside_(folder / nameAside(part)),
      lock_(folder / kFolderLock, name, part) {
  std::error_code error;
  fs::remove_all(aside_, error);  // a killed program may have left it
  if (!fs::create_directory(aside_, error))
    throw UsageError(name + ": cannot make files here; choose a folder that is there and writable");
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  fs::remove_all(aside_, ignored);
}

void OutputFolder::publish(const std::string& mark,
                           const std::vector<std::string>& other_marks) const {
  std::vector<fs::path> names;
  for (const fs::directory_entry& file : fs::directory_iterator(aside_))
    if (file.path().filename() != mark) names.push_back(file.path().filename());

  fs::remove(folder_ / mark);
  for (const std::string& other : other_marks) fs::remove(folder_ / other);
  for (const fs::path& name : names) fs::remove(folder_ / name);
  for (const fs::path& name : names) fs::rename(aside_ / name, folder_ / name);
  fs::rename(aside_ / mark, folder_ / mark);
}

void writeText(const fs::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream)
    throw Error("cannot write " + file.string() + ": is the folder there, writable and not full?");
}

}  // namespace tandem::demos
