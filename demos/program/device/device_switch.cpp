#include "device/device_switch.h"

#include <charconv>
#include <vector>

#include <fmt/format.h>

#include "tandem/falcon/falcon_status.h"
#include "tandem/falcon/gamepad_device.h"

#include "device/plugged_in.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

[[noreturn]] void refuse(const char* option, const std::string& text) {
  throw UsageError(
      fmt::format("{} {}: allowed: plus, forward, centre, minus, south, east, north, west, left, "
                  "right, or "
                  "hid:PATH,KIND,REPORT,BYTE,VALUE with KIND bits, key or usage",
                  option, text));
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

/// Reads a decimal number, or one with 0x.
std::optional<int> readNumber(std::string_view text, int most) {
  const bool is_hex = text.starts_with("0x");
  if (is_hex) text.remove_prefix(2);
  int number = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number, is_hex ? 16 : 10);
  if (error != std::errc() || rest != end || number < 0 || number > most) return std::nullopt;
  return number;
}

std::optional<HidSwitchKind> readKind(std::string_view text) {
  if (text == "bits") return HidSwitchKind::kBits;
  if (text == "key") return HidSwitchKind::kKey;
  if (text == "usage") return HidSwitchKind::kUsage;
  return std::nullopt;
}

}  // namespace

SwitchSpec parseSwitch(const char* option, const std::string& text) {
  if (text == "plus") return {kPlusButton, "", {}};
  if (text == "forward") return {kForwardButton, "", {}};
  if (text == "centre") return {kCentreButton, "", {}};
  if (text == "minus") return {kMinusButton, "", {}};
  if (text == "south") return {kSouthButton, "", {}};
  if (text == "east") return {kEastButton, "", {}};
  if (text == "north") return {kNorthButton, "", {}};
  if (text == "west") return {kWestButton, "", {}};
  if (text == "left") return {kLeftShoulder, "", {}};
  if (text == "right") return {kRightShoulder, "", {}};
  if (!text.starts_with("hid:/")) refuse(option, text);
  const std::vector<std::string> parts = split(text.substr(4));
  if (parts.size() != 5) refuse(option, text);
  const auto kind = readKind(parts[1]);
  const auto report = readNumber(parts[2], 255), byte = readNumber(parts[3], 64),
             value = readNumber(parts[4], 0xFFFF);
  if (!kind || !report || !byte || !value) refuse(option, text);
  return {0,
          parts[0],
          {*kind, *report, static_cast<std::size_t>(*byte), static_cast<std::uint16_t>(*value)}};
}

DeviceSwitch::DeviceSwitch(const char* option, const std::optional<std::string>& text) {
  if (!text) return;
  const SwitchSpec spec = parseSwitch(option, *text);
  button_ = spec.button;
  if (spec.button == 0)
    pedal_ =
        std::make_unique<HidSwitch>([path = spec.path] { return openHidPath(path); }, spec.map);
}

bool DeviceSwitch::isPressed(const Driver& driver) const noexcept {
  if (pedal_) return pedal_->isPressed();
  return button_ != 0 && driver.pressed && (driver.pressed() & button_) != 0;
}

}  // namespace tandem::demos
