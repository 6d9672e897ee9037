#include "secure/key_text.h"

#include <algorithm>

namespace tandem::secure {
namespace {

constexpr std::string_view kFormat = "tandem-key-1";
constexpr std::size_t kDigits = 2 * kKeySize;

/// Size of the first line with its end; 0 if it is not a key's.
std::size_t measureHeader(std::string_view text) noexcept {
  if (!text.starts_with(kFormat)) return 0;
  const std::size_t end = text.substr(0, kLongestKeyHeader).find('\n');
  if (end == std::string_view::npos) return 0;
  if (end != kFormat.size() && text[kFormat.size()] != ' ') return 0;  // such as "tandem-key-10"
  return end + 1;
}

/// Value of a digit, or -1. Digits are secret, so no branch or table depends on them.
int valueOf(char digit) noexcept {
  const int c = static_cast<unsigned char>(digit), letter = c | 0x20;
  const int is_number = ((c - '0') | ('9' - c)) >= 0;
  const int is_letter = ((letter - 'a') | ('f' - letter)) >= 0;
  return is_number * (c - '0') + is_letter * (letter - 'a' + 10) + (is_number + is_letter) - 1;
}

KeyTextFault readDigits(std::string_view line, Bytes key) noexcept {
  const std::string_view digits = line.substr(0, std::min(kDigits, line.find('\n')));
  for (std::size_t i = 0; i < digits.size(); ++i) {
    const int value = valueOf(digits[i]);
    if (value < 0) return KeyTextFault::kDigits;
    const int high = i % 2 == 0 ? 0 : key[i / 2] << 4;
    key[i / 2] = static_cast<std::uint8_t>(high | value);
  }
  if (digits.size() < kDigits || line.size() == kDigits) return KeyTextFault::kTooShort;
  return line.substr(kDigits) == "\n" ? KeyTextFault::kNone : KeyTextFault::kTrailing;
}

}  // namespace

void writeKeyText(ByteView key, std::array<char, kKeyTextSize>& text) noexcept {
  char* const digits = std::copy(kKeyHeader.begin(), kKeyHeader.end(), text.begin());
  sodium_bin2hex(digits, kDigits + 1, key.data(), kKeySize);
  text.back() = '\n';  // overwrites the final 0 of bin2hex
}

KeyTextFault readKeyText(std::string_view text, Bytes key) noexcept {
  const std::size_t header = measureHeader(text);
  const KeyTextFault fault =
      header == 0 ? KeyTextFault::kHeader : readDigits(text.substr(header), key);
  if (fault != KeyTextFault::kNone) sodium_memzero(key.data(), kKeySize);
  return fault;
}

const char* describe(KeyTextFault fault) noexcept {
  switch (fault) {
    case KeyTextFault::kNone:
      break;
    case KeyTextFault::kHeader:
      return "is no key file: line 1 must begin with tandem-key-1; make one with tandem key new";
    case KeyTextFault::kDigits:
      return "line 2 must be 64 hexadecimal digits, and one character is none; copy the file again";
    case KeyTextFault::kTooShort:
      return "line 2 is too short or does not end, must be 64 hexadecimal digits; copy the file "
             "again";
    case KeyTextFault::kTrailing:
      return "something follows the 64 hexadecimal digits of line 2, which must end the file; copy "
             "the file again";
  }
  return "holds a key";
}

}  // namespace tandem::secure
