#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "files/output_lock.h"

namespace tandem::demos {

/// File in an output folder by which programs keep each other out.
inline constexpr const char* kFolderLock = ".tandem-lock";

/// A folder for results, locked against other programs. Files are written aside and published
/// together, so the folder has an older result, none, or a whole new one, even if the process is
/// killed.
class OutputFolder {
 public:
  /// Makes the folder if needed. Throws UsageError, which begins with `name`, if it is not writable
  /// or in use.
  OutputFolder(const std::filesystem::path& folder, const std::string& name,
               FolderPart part = FolderPart::kAll);
  /// Removes all files that were not published.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Path of a file that is still to be published.
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return aside_ / name;
  }

  /// Moves all files into the folder. A result is there as long as `mark` is: older files leave
  /// after their mark, and the new `mark` comes last. Marks of other results, which the new files
  /// would spoil, leave too. Throws std::filesystem::filesystem_error that names the file.
  void publish(const std::string& mark, const std::vector<std::string>& other_marks = {}) const;

 private:
  std::filesystem::path folder_, aside_;
  OutputLock lock_;
};

/// Stores `text` as a file. Throws Error with the file's name.
void writeText(const std::filesystem::path& file, const std::string& text);

}  // namespace tandem::demos
