#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tandem::wire {

/// Length of the UTF-8 sequence at the front of the nonempty `text`. 0 if it is ill-formed (Unicode
/// 15, table 3-7) or a control character.
[[nodiscard]] inline std::size_t measurePrintable(std::string_view text) noexcept {
  const auto byte = [&text](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const auto within = [&](std::size_t i, unsigned low, unsigned high) {
    return i < text.size() && byte(i) >= low && byte(i) <= high;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  if (first == 0xc2) return within(1, 0xa0, 0xbf) ? 2 : 0;  // below 0xa0 are the Latin-1 controls
  if (first > 0xc2 && first < 0xe0) return within(1, 0x80, 0xbf) ? 2 : 0;
  if (first >= 0xe0 && first < 0xf0) {
    const unsigned low = first == 0xe0 ? 0xa0 : 0x80;   // refuses overlong forms
    const unsigned high = first == 0xed ? 0x9f : 0xbf;  // refuses surrogates
    return within(1, low, high) && within(2, 0x80, 0xbf) ? 3 : 0;
  }
  if (first >= 0xf0 && first <= 0xf4) {
    const unsigned low = first == 0xf0 ? 0x90 : 0x80;
    const unsigned high = first == 0xf4 ? 0x8f : 0xbf;  // up to U+10FFFF
    return within(1, low, high) && within(2, 0x80, 0xbf) && within(3, 0x80, 0xbf) ? 4 : 0;
  }
  return 0;
}

/// True if all of the text is UTF-8 without control characters.
[[nodiscard]] inline bool isPrintable(std::string_view text) noexcept {
  while (!text.empty()) {
    const std::size_t length = measurePrintable(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

}  // namespace tandem::wire
