#include "gamepad/event_bits.h"

#include <algorithm>
#include <charconv>

#include <linux/input.h>

namespace tandem::falcon_detail {
namespace {

constexpr std::uint16_t kLastButton = BTN_GAMEPAD + 15;
constexpr std::size_t kLongestText = 60;

/// Cuts the last word off `text`.
std::string_view takeLastWord(std::string_view& text) noexcept {
  constexpr std::string_view kSpaces = " \n";
  const std::size_t end = text.find_last_not_of(kSpaces);
  text = text.substr(0, end == std::string_view::npos ? 0 : end + 1);
  const std::size_t space = text.find_last_of(kSpaces);
  const std::size_t begin = space == std::string_view::npos ? 0 : space + 1;
  const std::string_view word = text.substr(begin);
  text = text.substr(0, begin);
  return word;
}

std::uint64_t parseWord(std::string_view word) noexcept {
  std::uint64_t value = 0;
  const char* const end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, value, 16);
  return error == std::errc() && rest == end ? value : 0;
}

}  // namespace

EventBits parseEventBits(std::string_view text, std::size_t word) noexcept {
  EventBits bits;
  for (std::size_t first = 0; first < bits.bytes.size(); first += word) {
    const std::uint64_t value = parseWord(takeLastWord(text));
    for (std::size_t i = 0; i < std::min(word, bits.bytes.size() - first); ++i)
      bits.bytes[first + i] = static_cast<std::uint8_t>(value >> (8 * i));
  }
  return bits;
}

Feel chooseFeel(const EventBits& effects) noexcept {
  if (effects.has(FF_RUMBLE)) return Feel::kRumble;
  return effects.has(FF_CONSTANT) ? Feel::kForce : Feel::kNothing;
}

bool isGamepad(const EventBits& axes, const EventBits& keys) noexcept {
  bool has_button = false;
  for (std::uint16_t code = BTN_JOYSTICK; code <= kLastButton; ++code)
    has_button = has_button || keys.has(code);
  return has_button && axes.has(ABS_X);
}

std::string toPrintable(std::string_view text) {
  std::string printable(text.substr(0, kLongestText));
  std::replace_if(
      printable.begin(), printable.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return printable;
}

}  // namespace tandem::falcon_detail
