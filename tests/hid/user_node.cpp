#include "hid/user_node.h"

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "tandem/coordination/types.h"

namespace tandem::test {
namespace {

struct Nodes {
  std::mutex mutex;
  std::vector<UserNode*> all;
};

Nodes& nodes() {
  static Nodes nodes;
  return nodes;
}

}  // namespace

UserNode::UserNode(std::string path, int socket_options)
    : path_(std::move(path)), socket_options_(socket_options) {
  plugIn();
  const std::lock_guard held(nodes().mutex);
  nodes().all.push_back(this);
}

UserNode::~UserNode() {
  {
    const std::lock_guard held(nodes().mutex);
    std::erase(nodes().all, this);
  }
  unplug();
}

void UserNode::plugIn() {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | socket_options_, 0, ends) != 0)
    throw Error("no socket for a device in user space");
  const std::lock_guard held(mutex_);
  ours_ = ends[0];
  theirs_ = ends[1];
}

void UserNode::unplug() {
  const std::lock_guard held(mutex_);
  if (ours_ >= 0) ::close(ours_);
  if (theirs_ >= 0) ::close(theirs_);
  ours_ = theirs_ = -1;
  files_.clear();
}

void UserNode::refuseToOpen(int error) {
  const std::lock_guard held(mutex_);
  error_ = error;
}

bool UserNode::waitForMessage(double wait) const {
  pollfd socket{ours_, POLLIN, 0};
  return ::poll(&socket, 1, static_cast<int>(wait * 1e3)) > 0;
}

int UserNode::failWith(int reason) {
  errno = reason;
  return -1;
}

int UserNode::openFile() {
  const std::lock_guard held(mutex_);
  if (theirs_ < 0) return failWith(ENOENT);
  if (error_ != 0) return failWith(error_);
  const int file = ::fcntl(theirs_, F_DUPFD_CLOEXEC, 0);
  if (file >= 0) files_.push_back(file);
  return file;
}

UserNode* UserNode::find(const std::string& path) {
  const std::lock_guard held(nodes().mutex);
  for (UserNode* node : nodes().all)
    if (node->path_ == path) return node;
  return nullptr;
}

UserNode* UserNode::find(int file) {
  const std::lock_guard held(nodes().mutex);
  for (UserNode* node : nodes().all) {
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
  if (tandem::test::UserNode* const node = tandem::test::UserNode::find(std::string(path)))
    return node->openFile();
  return static_cast<int>(::syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}

extern "C" int ioctl(int file, unsigned long request, ...) noexcept {
  va_list arguments;
  va_start(arguments, request);
  void* const argument = va_arg(arguments, void*);
  va_end(arguments);
  if (tandem::test::UserNode* const node = tandem::test::UserNode::find(file))
    return node->control(request, argument);
  return static_cast<int>(::syscall(SYS_ioctl, file, request, argument));
}
