#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "tandem/falcon/hid_port.h"

/// \file
/// Reports of an FT260's serial interface (FTDI's application note AN_394):
///
///     feature A1   03 04                                      UART on, without flow control
///                  41 04 baud(4, low byte first) 08 00 00 00  baud, 8 bits, no parity, 1 stop bit
///     data    F0+k count bytes...                             up to 4 (k + 1) bytes, k to 14
///
/// A frame of 16 bytes is sent as F3 10 and the frame, both ways. Every byte from the device is
/// checked. Pure and real-time safe.
namespace tandem {

inline constexpr std::size_t kMostUartBytes = 60;  ///< capacity of one report
inline constexpr int kLeastUartBaud = 1200, kMostUartBaud = 12'000'000;

struct UartBytes {
  std::array<std::uint8_t, kMostUartBytes> bytes{};
  std::size_t count = 0;
};

/// Makes a report with the first 60 of `count` bytes. Returns an empty report if `count` is 0.
[[nodiscard]] HidReport encodeUartBytes(const std::uint8_t* bytes, std::size_t count) noexcept;

/// Returns nothing if the report carries no data or its count exceeds its size.
[[nodiscard]] std::optional<UartBytes> decodeUartBytes(const std::uint8_t* report,
                                                       std::size_t size) noexcept;

/// Feature reports that set up the serial line.
[[nodiscard]] HidReport makeUartOn() noexcept;
[[nodiscard]] HidReport makeUartLine(std::uint32_t baud) noexcept;

}  // namespace tandem
