#include "files/output_lock.h"

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

OutputLock::OutputLock(const std::filesystem::path& file, const std::string& name, FolderPart part)
    : path_(file) {
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
    throw UsageError(name + (is_taken ? ": another tandem is writing here; wait for "
                                        "its end or choose another place"
                                      : std::string(": cannot be locked (") + std::strerror(cause) +
                                            "); choose a place on another disk"));
  }
}

OutputLock::~OutputLock() {
  // The last user removes the file; whoever opened it meanwhile makes a new one. Each lets its part
  // go first: two that end at once would keep each other from having it all.
  unlock();
  if (lock(FolderPart::kAll) && isStillThere()) ::unlink(path_.c_str());
  ::close(file_);
}

void OutputLock::open(const std::string& name) {
  file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW, 0666);
  if (file_ < 0)
    throw UsageError(name + ": cannot make files here; choose a folder that is there and writable");
}

/// Locks a byte for each site, or all bytes. Such a lock belongs to the open file.
bool OutputLock::lock(FolderPart part) const noexcept {
  if (part == FolderPart::kAll) return set(F_WRLCK, 0, 0);  // to the end
  return set(F_WRLCK, static_cast<off_t>(part), 1);
}

void OutputLock::unlock() const noexcept { set(F_UNLCK, 0, 0); }

bool OutputLock::set(short kind, off_t start, off_t length) const noexcept {
  struct flock range {};
  range.l_type = kind;
  range.l_whence = SEEK_SET;
  range.l_start = start;
  range.l_len = length;
  return ::fcntl(file_, F_OFD_SETLK, &range) == 0;
}

bool OutputLock::isStillThere() const noexcept {
  struct stat opened {
  }, named{};
  return ::fstat(file_, &opened) == 0 && ::lstat(path_.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

}  // namespace tandem::demos
