#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <linux/input.h>

namespace tandem::test {

/// An input node of Linux played by this process, as UserHidraw plays a hidraw node: open() and
/// ioctl() end here, read(), write() and poll() on a socket. It answers as evdev does, and keeps
/// effects. Thread safe.
class UserEvdev {
 public:
  /// Creates a plugged-in node that no real system has: "/dev/input/tandem-NAME".
  explicit UserEvdev(const std::string& name);
  ~UserEvdev();
  UserEvdev(const UserEvdev&) = delete;
  UserEvdev& operator=(const UserEvdev&) = delete;

  [[nodiscard]] const std::string& path() const noexcept { return path_; }

  // The device; set before it is opened.
  std::map<int, input_absinfo> axes;
  std::vector<int> effects;  ///< codes of the effects that it can play
  int error = 0;             ///< of each attempt to open it; 0: none

  void press(int key);
  /// Sends bytes as they are, whole events or not.
  void send(const void* bytes, std::size_t size);
  void send(std::uint16_t type, std::uint16_t code, std::int32_t value);
  /// The next event written to the device, after waiting for it up to `wait` [s].
  [[nodiscard]] std::optional<input_event> receive(double wait);
  void unplug();

  [[nodiscard]] std::map<int, ff_effect> uploaded();

  /// Used by open() and ioctl() of this program; returns -1 and sets errno like the system.
  [[nodiscard]] int openFile();
  [[nodiscard]] int control(unsigned long request, void* argument);
  /// Finds the node with this path, or the node of this file.
  [[nodiscard]] static UserEvdev* find(const std::string& path);
  [[nodiscard]] static UserEvdev* find(int file);

 private:
  [[nodiscard]] int upload(ff_effect& effect);
  [[nodiscard]] int giveBits(unsigned type, void* to, std::size_t size);

  std::string path_;
  std::mutex mutex_;
  int ours_ = -1, theirs_ = -1;  ///< ends of the socket
  std::vector<int> files_;
  std::array<std::uint8_t, KEY_MAX / 8 + 1> keys_{};
  std::map<int, ff_effect> uploaded_;
};

}  // namespace tandem::test
