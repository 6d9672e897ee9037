#pragma once

#include <filesystem>
#include <string>

#include <sys/types.h>

namespace tandem::demos {

/// Part of an output folder that one program writes: all of it, or that of one site of a live run,
/// whose number is above 0. Sites of a run may share a folder.
enum class FolderPart : int { kAll = 0 };

/// Keeps other programs from writing the same output until the end of this object or of the
/// process, however that ends. The system forgets the lock with the process, so none is ever left
/// over. A child process inherits it, because it may still write after its parent was killed.
class OutputLock {
 public:
  /// `file` is made for the lock and removed by its last user. Throws UsageError, which begins with
  /// `name`, if another program has the part or if the file cannot be made.
  OutputLock(const std::filesystem::path& file, const std::string& name,
             FolderPart part = FolderPart::kAll);
  ~OutputLock();
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;

 private:
  void open(const std::string& name);
  [[nodiscard]] bool lock(FolderPart part) const noexcept;
  void unlock() const noexcept;
  bool set(short kind, off_t start, off_t length) const noexcept;
  [[nodiscard]] bool isStillThere() const noexcept;

  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace tandem::demos
