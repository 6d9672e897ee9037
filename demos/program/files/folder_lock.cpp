#include "files/folder_lock.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tandem/falcon/monotonic_clock.h"

#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

// A user that ends holds all of the folder for a moment, so a first refusal may be no lasting one.
constexpr int kTries = 20;
constexpr double kPause = 0.005;  // between tries [s]

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder, FolderPart part,
                       const std::string& name)
    : path_(folder / ".tandem-lock") {
  for (int tries = 1;; ++tries) {
    open(name);
    const bool is_locked = lock(part);
    const int cause = errno;
    if (is_locked && isStillThere()) return;
    ::close(file_);
    if (is_locked) continue;  // its last user removed the file between open() and lock()
    const bool is_taken = cause == EAGAIN || cause == EACCES;
    if (is_taken && tries < kTries) {
      sleepFor(kPause);
      continue;
    }
    throw UsageError(name + (is_taken ? ": another tandem is writing into this folder; wait for "
                                        "its end or choose another folder"
                                      : std::string(": cannot be locked (") + std::strerror(cause) +
                                            "); choose a folder on another disk"));
  }
}

FolderLock::~FolderLock() {
  // The last user removes the file; whoever opened it meanwhile makes a new one.
  if (lock(FolderPart::kAll)) ::unlink(path_.c_str());
  ::close(file_);
}

void FolderLock::open(const std::string& name) {
  file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW, 0666);
  if (file_ < 0)
    throw UsageError(name + ": cannot make files in this folder; choose one that is writable");
}

/// Locks a byte for each site, or all bytes. Such a lock belongs to the open file.
bool FolderLock::lock(FolderPart part) const noexcept {
  struct flock range {};
  range.l_type = F_WRLCK;
  range.l_whence = SEEK_SET;
  range.l_start = part == FolderPart::kSite2 ? 1 : 0;
  range.l_len = part == FolderPart::kAll ? 0 : 1;  // 0: to the end
  return ::fcntl(file_, F_OFD_SETLK, &range) == 0;
}

bool FolderLock::isStillThere() const noexcept {
  struct stat opened {
  }, named{};
  return ::fstat(file_, &opened) == 0 && ::lstat(path_.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

}  // namespace tandem::demos
