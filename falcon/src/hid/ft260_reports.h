#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "tandem/falcon/hid_port.h"

/// \file
/// What the serial interface of an FT260 says and hears (FTDI's application note AN_394):
///
///     feature A1   03 04                                      UART on, without flow control
///                  41 04 baud(4, low byte first) 08 00 00 00  baud, 8 bits, no parity, 1 stop bit
///     data    F0+k count bytes...                             up to 4 (k + 1) bytes, k to 14
///
/// A frame of 16 bytes is F3 10 and the frame, both ways. Bytes from a device are never trusted.
/// Pure and real-time safe.
#pragma GCC visibility push(default)
namespace tandem {

inline constexpr std::size_t kMostUartBytes = 60;  ///< in one report
inline constexpr int kLeastUartBaud = 1200, kMostUartBaud = 12'000'000;

struct UartBytes {
  std::array<std::uint8_t, kMostUartBytes> bytes{};
  std::size_t count = 0;
};

/// A report with these bytes, 1 to 60 of them; of more, the first 60. `count` 0: no report.
[[nodiscard]] HidReport encodeUartBytes(const std::uint8_t* bytes, std::size_t count) noexcept;

/// Nothing for a report that is not about bytes, or claims more of them than it has.
[[nodiscard]] std::optional<UartBytes> decodeUartBytes(const std::uint8_t* report,
                                                       std::size_t size) noexcept;

/// Feature reports that make it a serial line.
[[nodiscard]] HidReport makeUartOn() noexcept;
[[nodiscard]] HidReport makeUartLine(std::uint32_t baud) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
