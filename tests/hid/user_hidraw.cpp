#include "hid/user_hidraw.h"

#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstring>

#include <fcntl.h>
#include <linux/hidraw.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "hid/user_evdev.h"

namespace tandem::test {
namespace {

constexpr int kHidType = 'H';  // type of hidraw's requests

std::mutex& nodesMutex() {
  static std::mutex mutex;
  return mutex;
}

std::vector<UserHidraw*>& nodes() {
  static std::vector<UserHidraw*> all;
  return all;
}

int failWith(int reason) {
  errno = reason;
  return -1;
}

}  // namespace

UserHidraw::UserHidraw(const std::string& name, Bytes descriptor)
    : path_("/dev/hidraw-" + name), descriptor_(std::move(descriptor)) {
  // The kernel returns an error on writes to an unplugged node; a socket also raises a signal.
  std::signal(SIGPIPE, SIG_IGN);
  plugIn();
  const std::lock_guard held(nodesMutex());
  nodes().push_back(this);
}

UserHidraw::~UserHidraw() {
  {
    const std::lock_guard held(nodesMutex());
    std::erase(nodes(), this);
  }
  unplug();
}

HidAddress UserHidraw::address() const {
  HidAddress address;
  address.path = path_;
  return address;
}

void UserHidraw::plugIn() {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
    throw Error("no socket for a HID device in user space");
  const std::lock_guard held(mutex_);
  ours_ = ends[0];
  theirs_ = ends[1];
}

void UserHidraw::unplug() {
  const std::lock_guard held(mutex_);
  if (ours_ >= 0) ::close(ours_);
  if (theirs_ >= 0) ::close(theirs_);
  ours_ = theirs_ = -1;
  files_.clear();
}

void UserHidraw::setForbidden(bool is_forbidden) {
  const std::lock_guard held(mutex_);
  is_forbidden_ = is_forbidden;
}

void UserHidraw::setFeatures(Features take, Answers give) {
  const std::lock_guard held(mutex_);
  take_ = std::move(take);
  give_ = std::move(give);
}

bool UserHidraw::send(const Bytes& report) {
  return ::send(ours_, report.data(), report.size(), 0) ==
         static_cast<std::ptrdiff_t>(report.size());
}

std::optional<Bytes> UserHidraw::receive(double wait) {
  pollfd socket{ours_, POLLIN, 0};
  if (::poll(&socket, 1, static_cast<int>(wait * 1e3)) <= 0) return std::nullopt;
  Bytes report(256);
  const std::ptrdiff_t size = ::recv(ours_, report.data(), report.size(), 0);
  if (size <= 0) return std::nullopt;
  report.resize(static_cast<std::size_t>(size));
  return report;
}

int UserHidraw::openFile() {
  const std::lock_guard held(mutex_);
  if (theirs_ < 0) return failWith(ENOENT);
  if (is_forbidden_) return failWith(EACCES);
  const int file = ::fcntl(theirs_, F_DUPFD_CLOEXEC, 0);
  if (file >= 0) files_.push_back(file);
  return file;
}

int UserHidraw::control(unsigned long request, void* argument) {
  const std::lock_guard held(mutex_);
  if (request == HIDIOCGRDESCSIZE) {
    const int size = static_cast<int>(descriptor_.size());
    std::memcpy(argument, &size, sizeof size);
    return 0;
  }
  auto* const bytes = static_cast<std::uint8_t*>(argument);
  const std::size_t size = _IOC_SIZE(request);
  if (request == HIDIOCSFEATURE(size) && take_) {
    take_(Bytes(bytes, bytes + size));
    return static_cast<int>(size);
  }
  if (request == HIDIOCGFEATURE(size) && give_) {
    const Bytes answer = give_(bytes[0]);
    if (answer.empty()) return failWith(EIO);
    const std::size_t count = std::min(size, answer.size());
    std::copy_n(answer.begin(), count, bytes);
    return static_cast<int>(count);
  }
  return failWith(EINVAL);
}

UserHidraw* UserHidraw::find(const std::string& path) {
  const std::lock_guard held(nodesMutex());
  for (UserHidraw* node : nodes())
    if (node->path_ == path) return node;
  return nullptr;
}

UserHidraw* UserHidraw::find(int file) {
  const std::lock_guard held(nodesMutex());
  for (UserHidraw* node : nodes()) {
    const std::lock_guard node_held(node->mutex_);
    if (std::find(node->files_.begin(), node->files_.end(), file) != node->files_.end())
      return node;
  }
  return nullptr;
}

}  // namespace tandem::test

// hidapi and openGamepad() find these before the C library's functions. They call the kernel
// directly, past the sanitizers' versions; only the latter's argument checks are lost.

extern "C" int open(const char* path, int flags, ...) {
  mode_t mode = 0;
  if (flags & (O_CREAT | O_TMPFILE)) {
    va_list arguments;
    va_start(arguments, flags);
    mode = va_arg(arguments, mode_t);
    va_end(arguments);
  }
  if (std::strncmp(path, "/dev/hidraw-", 12) == 0) {
    tandem::test::UserHidraw* const node = tandem::test::UserHidraw::find(std::string(path));
    return node ? node->openFile() : tandem::test::failWith(ENOENT);
  }
  if (tandem::test::UserEvdev* const node = tandem::test::UserEvdev::find(std::string(path)))
    return node->openFile();
  return static_cast<int>(::syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}

extern "C" int ioctl(int file, unsigned long request, ...) noexcept {
  va_list arguments;
  va_start(arguments, request);
  void* const argument = va_arg(arguments, void*);
  va_end(arguments);
  if (_IOC_TYPE(request) == tandem::test::kHidType)
    if (tandem::test::UserHidraw* const node = tandem::test::UserHidraw::find(file))
      return node->control(request, argument);
  if (_IOC_TYPE(request) == 'E')
    if (tandem::test::UserEvdev* const node = tandem::test::UserEvdev::find(file))
      return node->control(request, argument);
  return static_cast<int>(::syscall(SYS_ioctl, file, request, argument));
}
