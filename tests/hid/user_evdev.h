#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <linux/input.h>

#include "hid/user_node.h"

namespace tandem::test {

/// An input node of Linux played by this process. It answers as evdev does, and keeps effects.
class UserEvdev final : public UserNode {
 public:
  /// Creates a plugged-in node that no real system has: "/dev/input/tandem-NAME".
  explicit UserEvdev(const std::string& name);

  // The device; set before it is opened.
  std::map<int, input_absinfo> axes;
  std::vector<int> effects;  ///< codes of the effects that it can play

  void press(int key);
  /// Sends bytes as they are, whole events or not.
  void send(const void* bytes, std::size_t size);
  void send(std::uint16_t type, std::uint16_t code, std::int32_t value);
  /// The next event written to the device, after waiting for it up to `wait` [s].
  [[nodiscard]] std::optional<input_event> receive(double wait);

  [[nodiscard]] std::map<int, ff_effect> uploaded();

  [[nodiscard]] int control(unsigned long request, void* argument) override;

 private:
  [[nodiscard]] int upload(ff_effect& effect);
  [[nodiscard]] int giveBits(unsigned type, void* to, std::size_t size);

  std::array<std::uint8_t, KEY_MAX / 8 + 1> keys_{};
  std::map<int, ff_effect> uploaded_;
};

}  // namespace tandem::test
