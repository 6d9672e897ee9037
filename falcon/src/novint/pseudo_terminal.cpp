#include "novint/pseudo_terminal.h"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <asm/termbits.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "tandem/coordination/types.h"
#include "tandem/falcon/monotonic_clock.h"

namespace tandem::falcon_detail {

PseudoTerminal::PseudoTerminal() : fd_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
  std::array<char, 64> name{};
  termios2 settings{};
  if (fd_ < 0 || ::grantpt(fd_) != 0 || ::unlockpt(fd_) != 0 ||
      ::ptsname_r(fd_, name.data(), name.size()) != 0 || ::ioctl(fd_, TCGETS2, &settings) != 0) {
    const std::string why = std::strerror(errno);
    if (fd_ >= 0) ::close(fd_);
    throw Error("no pseudo terminal (" + why + "); is /dev/pts mounted?");
  }
  path_ = name.data();
  // Raw mode from the start: otherwise the terminal echoes the device's bytes back to it.
  settings.c_iflag = settings.c_oflag = settings.c_lflag = 0;
  ::ioctl(fd_, TCSETS2, &settings);
}

PseudoTerminal::~PseudoTerminal() { ::close(fd_); }

int PseudoTerminal::readSpeed() const noexcept {
  termios2 settings{};
  return ::ioctl(fd_, TCGETS2, &settings) == 0 ? static_cast<int>(settings.c_ospeed) : 0;
}

std::size_t PseudoTerminal::read(std::uint8_t* bytes, std::size_t room, double wait) noexcept {
  pollfd what{fd_, POLLIN, 0};
  const timespec time{0, static_cast<long>(wait * 1e9)};
  if (::ppoll(&what, 1, &time, nullptr) <= 0) return 0;
  const ssize_t count = ::read(fd_, bytes, room);
  if (count > 0) return static_cast<std::size_t>(count);
  // poll() returns at once while no program has the terminal open.
  sleepFor(wait);
  return 0;
}

void PseudoTerminal::write(const std::uint8_t* bytes, std::size_t count) noexcept {
  (void)!::write(fd_, bytes, count);
}

}  // namespace tandem::falcon_detail
