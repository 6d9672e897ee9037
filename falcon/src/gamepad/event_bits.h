#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "tandem/falcon/event_port.h"

namespace tandem::falcon_detail {

/// The codes that a device knows, one bit for each, as the kernel gives them.
struct EventBits {
  std::array<std::uint8_t, 96> bytes{};  ///< 768 codes: all keys of Linux

  [[nodiscard]] bool has(std::size_t code) const noexcept {
    return code / 8 < bytes.size() && (bytes[code / 8] >> (code % 8) & 1) != 0;
  }
};

/// Reads the bits from a file of the system folder: words of `word` bytes in hexadecimal, the
/// highest first. Words that make no sense, or lie beyond the last code, count as zero.
[[nodiscard]] EventBits parseEventBits(std::string_view text,
                                       std::size_t word = sizeof(long)) noexcept;

/// The best effect of a device with these effects: rumble before force.
[[nodiscard]] Feel chooseFeel(const EventBits& effects) noexcept;

/// True for the axes and keys of a gamepad, joystick or wheel.
[[nodiscard]] bool isGamepad(const EventBits& axes, const EventBits& keys) noexcept;

/// The text for a line of a message: without control characters, at most 60 bytes.
[[nodiscard]] std::string toPrintable(std::string_view text);

}  // namespace tandem::falcon_detail
