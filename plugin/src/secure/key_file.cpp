#include "tandem/plugin/key_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tandem/coordination/types.h"

#include "secure/key_text.h"
#include "secure/locked_memory.h"

namespace tandem {
namespace {

namespace fs = std::filesystem;
using secure::LockedBox;

constexpr mode_t kOwnerOnly = S_IRUSR | S_IWUSR;
constexpr mode_t kOthers = S_IRWXG | S_IRWXO;

/// A file descriptor that closes itself.
class OpenFile {
 public:
  explicit OpenFile(int descriptor) noexcept : descriptor_(descriptor) {}
  ~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  [[nodiscard]] int get() const noexcept { return descriptor_; }
  [[nodiscard]] bool close() noexcept { return ::close(std::exchange(descriptor_, -1)) == 0; }

 private:
  int descriptor_;
};

/// Makes a message of one line, whatever characters the name has.
std::string makeMessage(const fs::path& path, const std::string& what) {
  std::string name = path.string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, '?');
  return name + ": " + what;
}

[[noreturn]] void refuse(const fs::path& path, const std::string& what) {
  throw std::invalid_argument(makeMessage(path, what));
}

bool writeAll(const OpenFile& file, const char* text, std::size_t size) noexcept {
  while (size > 0) {
    const ssize_t written = ::write(file.get(), text, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    text += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

/// Reads a file, up to the size of the buffer. Returns false on an error.
bool readAll(const OpenFile& file, char* buffer, std::size_t room, std::size_t& size) noexcept {
  size = 0;
  while (size < room) {
    const ssize_t got = ::read(file.get(), buffer + size, room - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return false;
    if (got == 0) return true;
    size += static_cast<std::size_t>(got);
  }
  return true;
}

/// Throws unless it is a regular file that only the owner has rights to.
void requirePrivateFile(const OpenFile& file, const fs::path& path) {
  struct stat status {};
  if (fstat(file.get(), &status) != 0) refuse(path, std::strerror(errno));
  if (!S_ISREG(status.st_mode)) refuse(path, "is no regular file; name a key file");
  if ((status.st_mode & kOthers) != 0) {
    std::array<char, 8> mode{};
    std::snprintf(mode.data(), mode.size(), "%04o", status.st_mode & 07777U);
    refuse(path, std::string("others have rights to this key (mode ") + mode.data() +
                     "); run: chmod 600 " + path.string());
  }
}

}  // namespace

void makeKeyFile(const fs::path& path) {
  const SecretKey key = SecretKey::generate();
  const LockedBox<std::array<char, secure::kKeyTextSize>> text;
  secure::writeKeyText({key.data(), SecretKey::kSize}, *text);

  OpenFile file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kOwnerOnly));
  if (file.get() < 0) {
    if (errno == EEXIST)
      refuse(path,
             "is there already, and a key is never overwritten; give another name, or remove "
             "it once no site uses it");
    refuse(path, std::string("cannot be made: ") + std::strerror(errno) +
                     "; give a name in a folder that is there and may be written to");
  }
  // The process's umask may have removed rights.
  const bool is_written = fchmod(file.get(), kOwnerOnly) == 0 &&
                          writeAll(file, text->data(), text->size()) && fsync(file.get()) == 0;
  const int error = errno;
  if (!file.close() || !is_written) {
    const std::string reason = std::strerror(is_written ? errno : error);
    ::unlink(path.c_str());
    throw Error(makeMessage(path, "cannot be written: " + reason + "; is the disk full?"));
  }
}

SecretKey readKeyFile(const fs::path& path) {
  // Without O_NONBLOCK, opening a pipe would wait for its writer.
  const OpenFile file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (file.get() < 0)
    refuse(path, std::string("cannot be read: ") + std::strerror(errno) +
                     "; give a key file, or make one with tandem key new");
  requirePrivateFile(file, path);

  // One character more than the longest text reveals a longer file.
  const LockedBox<std::array<char, secure::kLongestKeyText + 1>> text;
  std::size_t size = 0;
  if (!readAll(file, text->data(), text->size(), size))
    refuse(path, std::string("cannot be read: ") + std::strerror(errno));
  std::array<std::uint8_t, SecretKey::kSize> bytes;
  const secure::KeyTextFault fault = secure::readKeyText({text->data(), size}, bytes);
  if (fault != secure::KeyTextFault::kNone) refuse(path, secure::describe(fault));
  return SecretKey::take(bytes);
}

}  // namespace tandem
