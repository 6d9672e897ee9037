#pragma once

#include <functional>
#include <optional>
#include <string>

#include "devices/fake_hid_port.h"
#include "hid/user_node.h"

namespace tandem::test {

/// A hidraw node played by this process. hidapi thus runs unchanged from end to end, without the
/// kernel's USB and HID drivers.
///
/// All open files of the node share one queue of input reports, while the kernel gives each its
/// own. So only one of them may be read from.
class UserHidraw final : public UserNode {
 public:
  using Features = std::function<void(const Bytes&)>;
  using Answers = std::function<Bytes(std::uint8_t identifier)>;

  /// Creates a plugged-in node. Paths are "/dev/hidraw-NAME", which no real system has.
  UserHidraw(const std::string& name, Bytes descriptor);

  [[nodiscard]] HidAddress address() const;

  /// Sends an input report to the open file. Returns false if unplugged, or if no reader takes
  /// reports.
  bool send(const Bytes& report);
  /// The next output report, after waiting for it up to `wait` [s].
  [[nodiscard]] std::optional<Bytes> receive(double wait);

  /// Sets the handlers of feature reports. The thread that sends or asks calls them. An empty
  /// answer is an error.
  void setFeatures(Features take, Answers give);

  [[nodiscard]] int control(unsigned long request, void* argument) override;

 private:
  Bytes descriptor_;
  Features take_;
  Answers give_;
};

}  // namespace tandem::test
