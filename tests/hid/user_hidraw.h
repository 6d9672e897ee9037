#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "devices/fake_hid_port.h"

namespace tandem::test {

/// A hidraw node that this process plays itself. This program's own open() and ioctl() know its
/// path, everything else goes to the system; read(), write() and poll() are the system's, on a
/// socket that keeps reports apart as a hidraw node does. So hidapi runs as it is, from end to end,
/// but for the kernel's USB and HID drivers.
///
/// Every file opened of the node shares one queue of input reports here, where the kernel gives
/// each its own: only one of them may be read from.
class UserHidraw {
 public:
  using Features = std::function<void(const Bytes&)>;
  using Answers = std::function<Bytes(std::uint8_t identifier)>;

  /// Plugged in. Paths are as "/dev/hidraw-NAME", which no system has.
  UserHidraw(const std::string& name, Bytes descriptor);
  ~UserHidraw();
  UserHidraw(const UserHidraw&) = delete;
  UserHidraw& operator=(const UserHidraw&) = delete;

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  [[nodiscard]] HidAddress address() const;

  /// An input report to whoever has the node open. False: unplugged, or nobody fetches them.
  bool send(const Bytes& report);
  /// The next output report, after waiting for it up to `wait` [s].
  [[nodiscard]] std::optional<Bytes> receive(double wait);

  void unplug();
  void plugIn();
  /// Opening then fails for lack of rights.
  void setForbidden(bool is_forbidden);

  /// What feature reports do; called by the thread that sends or asks. An empty answer: an error.
  void setFeatures(Features take, Answers give);

  /// For open() and ioctl() of this program; -1 and errno as the system has it.
  [[nodiscard]] int openFile();
  [[nodiscard]] int control(unsigned long request, void* argument);
  /// The node with this path; the node that this file is of.
  [[nodiscard]] static UserHidraw* find(const std::string& path);
  [[nodiscard]] static UserHidraw* find(int file);

 private:
  std::string path_;
  Bytes descriptor_;
  std::mutex mutex_;
  int ours_ = -1, theirs_ = -1;  ///< ends of the socket
  std::vector<int> files_;
  bool is_forbidden_ = false;
  Features take_;
  Answers give_;
};

}  // namespace tandem::test
