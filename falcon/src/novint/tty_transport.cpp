#include <cerrno>
#include <cmath>
#include <cstring>

#include <asm/termbits.h>
#include <fcntl.h>
#include <linux/serial.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "tandem/coordination/types.h"
#include "tandem/falcon/byte_transport.h"

namespace tandem {
namespace {

constexpr double kWriteTime = 0.1;  // the limit of ByteTransport::write() [s]

/// True once one of `events` occurs; false after `wait` [s] or if the line is gone.
bool waitFor(int fd, short events, double wait) noexcept {
  pollfd what{fd, events, 0};
  const double whole = std::floor(wait);
  const timespec time{static_cast<time_t>(whole), static_cast<long>((wait - whole) * 1e9)};
  return ::ppoll(&what, 1, &time, nullptr) > 0;
}

/// True for the errors of lines without such wires (pseudo terminals).
bool isMissing(int error) noexcept {
  return error == ENOTTY || error == EINVAL || error == EOPNOTSUPP;
}

class TtyTransport final : public ByteTransport {
 public:
  TtyTransport(int fd, std::string name) : fd_(fd), name_(std::move(name)) {}
  ~TtyTransport() override { ::close(fd_); }
  TtyTransport(const TtyTransport&) = delete;
  TtyTransport& operator=(const TtyTransport&) = delete;

  [[nodiscard]] const std::string& name() const noexcept override { return name_; }

  [[nodiscard]] bool write(const std::uint8_t* bytes, std::size_t count) noexcept override {
    while (count > 0) {
      const ssize_t sent = ::write(fd_, bytes, count);
      if (sent > 0) {
        bytes += sent;
        count -= static_cast<std::size_t>(sent);
      } else if (sent < 0 && errno == EINTR) {
        continue;
      } else if (sent < 0 && errno != EAGAIN) {
        return false;
      } else if (!waitFor(fd_, POLLOUT, kWriteTime)) {
        return false;
      }
    }
    return true;
  }

  [[nodiscard]] std::ptrdiff_t read(std::uint8_t* bytes, std::size_t room,
                                    double wait) noexcept override {
    std::ptrdiff_t count = readNow(bytes, room);
    if (count != 0 || !(wait > 0.0) || !waitFor(fd_, POLLIN, wait)) return count;
    count = readNow(bytes, room);
    return count;
  }

  [[nodiscard]] bool setLine(const SerialLine& line) noexcept override {
    return setModemLine(TIOCM_DTR, line.dtr) && setModemLine(TIOCM_RTS, line.rts) &&
           setSpeed(line.baud) && setLatency(line.latency_ms);
  }

  void purge() noexcept override { ::ioctl(fd_, TCFLSH, TCIOFLUSH); }

 private:
  /// read() without waiting.
  std::ptrdiff_t readNow(std::uint8_t* bytes, std::size_t room) noexcept {
    const ssize_t count = ::read(fd_, bytes, room);
    if (count > 0) return count;
    if (count < 0) return errno == EAGAIN || errno == EINTR ? 0 : -1;
    // A read of 0 bytes means a hang-up on some lines and no data on others; poll() tells.
    pollfd what{fd_, 0, 0};
    return ::poll(&what, 1, 0) > 0 && (what.revents & (POLLHUP | POLLERR)) != 0 ? -1 : 0;
  }

  /// Sets raw bytes, 8N1 and no flow control.
  bool setSpeed(int baud) noexcept {
    termios2 settings{};
    if (::ioctl(fd_, TCGETS2, &settings) != 0) return false;
    settings.c_iflag = settings.c_oflag = settings.c_lflag = 0;
    settings.c_cflag = BOTHER | (BOTHER << IBSHIFT) | CS8 | CREAD | CLOCAL;
    settings.c_ispeed = settings.c_ospeed = static_cast<speed_t>(baud);
    settings.c_cc[VMIN] = settings.c_cc[VTIME] = 0;
    return ::ioctl(fd_, TCSETS2, &settings) == 0;
  }

  bool setModemLine(int which, bool high) noexcept {
    return ::ioctl(fd_, high ? TIOCMBIS : TIOCMBIC, &which) == 0 || isMissing(errno);
  }

  /// The kernel's drivers offer only low or normal latency, no times.
  bool setLatency(int latency_ms) noexcept {
    serial_struct settings{};
    if (::ioctl(fd_, TIOCGSERIAL, &settings) != 0) return isMissing(errno);
    const int low = static_cast<int>(ASYNC_LOW_LATENCY);
    settings.flags = latency_ms < 16 ? settings.flags | low : settings.flags & ~low;
    return ::ioctl(fd_, TIOCSSERIAL, &settings) == 0 || isMissing(errno) || errno == EPERM;
  }

  int fd_;
  std::string name_;
};

[[noreturn]] void refuse(int fd, const std::string& path, const char* why, const char* remedy) {
  if (fd >= 0) ::close(fd);
  throw Error(path + ": " + why + "; " + remedy);
}

}  // namespace

std::unique_ptr<ByteTransport> openTty(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0)
    refuse(fd, path, std::strerror(errno),
           errno == EACCES  ? "add yourself to the group that owns it, usually dialout"
           : errno == EBUSY ? "end the other program that uses it"
                            : "is the device plugged in, and ftdi_sio bound to it?");
  if (::isatty(fd) == 0) refuse(fd, path, "is no serial line", "give a tty, such as /dev/ttyUSB0");
  // TIOCEXCL does not stop root; flock() stops programs that check for it.
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0 || ::ioctl(fd, TIOCEXCL) != 0)
    refuse(fd, path, "is in use", "end the other program that uses it");
  auto transport = std::make_unique<TtyTransport>(fd, path);
  if (!transport->setLine({}))
    throw Error(path + ": its speed cannot be set; give a serial line with termios2");
  return transport;
}

}  // namespace tandem
