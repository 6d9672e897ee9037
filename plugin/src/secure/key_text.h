#pragma once

#include <array>
#include <string_view>

#include "secure/bytes.h"
#include "secure/symmetric_state.h"

/// \file
/// Text of a key file: a line that begins with kKeyHeader, and a line of 64 hexadecimal digits.
namespace tandem::secure {

inline constexpr std::string_view kKeyHeader =
    "tandem-key-1 shared by two sites; whoever has it can speak for both\n";

/// Longest first line. It may differ after the format's name.
inline constexpr std::size_t kLongestKeyHeader = 128;

inline constexpr std::size_t kKeyTextSize = kKeyHeader.size() + 2 * kKeySize + 1;
inline constexpr std::size_t kLongestKeyText = kLongestKeyHeader + 2 * kKeySize + 1;

/// Faults of a key file's text.
enum class KeyTextFault {
  kNone,
  kHeader,    ///< the first line is not a key's
  kDigits,    ///< a character of the second line is no hexadecimal digit
  kTooShort,  ///< the second line has fewer than 64 digits, or no end
  kTrailing,  ///< something follows the 64 digits
};

/// Writes the text of a key, kKeyTextSize characters.
void writeKeyText(ByteView key, std::array<char, kKeyTextSize>& text) noexcept;

/// Reads the text of a key. On a fault wipes `key`, kKeySize bytes.
[[nodiscard]] KeyTextFault readKeyText(std::string_view text, Bytes key) noexcept;

/// Text of a fault with what is expected, for a message.
[[nodiscard]] const char* describe(KeyTextFault fault) noexcept;

}  // namespace tandem::secure
