#pragma once

#include <filesystem>
#include <string>

namespace tandem::demos {

/// Part of an output folder that one program writes. Both sites of a live run may share a folder.
enum class FolderPart { kAll, kSite1, kSite2 };

/// Keeps other programs out of a part of a folder until the end of this object or of the process,
/// however that ends. The system forgets the lock with the process, so none is ever left over. A
/// child process inherits it, because it may still write after its parent was killed.
class FolderLock {
 public:
  /// Throws UsageError, which begins with `name`, if another program has the part or if no file can
  /// be made in `folder`.
  FolderLock(const std::filesystem::path& folder, FolderPart part, const std::string& name);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  void open(const std::string& name);
  [[nodiscard]] bool lock(FolderPart part) const noexcept;
  [[nodiscard]] bool isStillThere() const noexcept;

  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace tandem::demos
