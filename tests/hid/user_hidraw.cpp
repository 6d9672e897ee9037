#include "hid/user_hidraw.h"

#include <cerrno>
#include <csignal>
#include <cstring>

#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

namespace tandem::test {

UserHidraw::UserHidraw(const std::string& name, Bytes descriptor)
    : UserNode("/dev/hidraw-" + name, 0), descriptor_(std::move(descriptor)) {
  // The kernel returns an error on writes to an unplugged node; a socket also raises a signal.
  std::signal(SIGPIPE, SIG_IGN);
}

HidAddress UserHidraw::address() const {
  HidAddress address;
  address.path = path();
  return address;
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
  if (!waitForMessage(wait)) return std::nullopt;
  Bytes report(256);
  const std::ptrdiff_t size = ::recv(ours_, report.data(), report.size(), 0);
  if (size <= 0) return std::nullopt;
  report.resize(static_cast<std::size_t>(size));
  return report;
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

}  // namespace tandem::test
