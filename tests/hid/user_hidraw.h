#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "devices/fake_hid_port.h"

namespace tandem::test {

/// A hidraw node played by this process. This program's own open() and ioctl() know its path and
/// pass all others to the system. read(), write() and poll() are the system's, on a socket that
/// keeps reports apart like a hidraw node. hidapi thus runs unchanged from end to end, without the
/// kernel's USB and HID drivers.
///
/// All open files of the node share one queue of input reports, while the kernel gives each its
/// own. So only one of them may be read from.
class UserHidraw {
 public:
  using Features = std::function<void(const Bytes&)>;
  using Answers = std::function<Bytes(std::uint8_t identifier)>;

  /// Creates a plugged-in node. Paths are "/dev/hidraw-NAME", which no real system has.
  UserHidraw(const std::string& name, Bytes descriptor);
  ~UserHidraw();
  UserHidraw(const UserHidraw&) = delete;
  UserHidraw& operator=(const UserHidraw&) = delete;

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  [[nodiscard]] HidAddress address() const;

  /// Sends an input report to the open file. Returns false if unplugged, or if no reader takes
  /// reports.
  bool send(const Bytes& report);
  /// The next output report, after waiting for it up to `wait` [s].
  [[nodiscard]] std::optional<Bytes> receive(double wait);

  void unplug();
  void plugIn();
  /// Makes opening fail for lack of rights.
  void setForbidden(bool is_forbidden);

  /// Sets the handlers of feature reports. The thread that sends or asks calls them. An empty
  /// answer is an error.
  void setFeatures(Features take, Answers give);

  /// Used by open() and ioctl() of this program; returns -1 and sets errno like the system.
  [[nodiscard]] int openFile();
  [[nodiscard]] int control(unsigned long request, void* argument);
  /// Finds the node with this path, or the node of this file.
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
