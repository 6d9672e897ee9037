#include "device/device_spec.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

using Kind = DeviceSpec::Kind;

constexpr const char* kAllowed =
    "falcon, falcon:SERIAL, falcon@/dev/ttyUSB0, falcon@ft260, emulated, simulated, "
    "spacemouse[:PATH], hid[:PATH], gamepad[:PATH]; tandem device list says what is plugged in";

[[noreturn]] void refuse(const char* option, const std::string& text) {
  throw UsageError(fmt::format("{} {}: no such device; allowed: {}", option, text, kAllowed));
}

bool isPath(std::string_view place) { return place.size() > 1 && place.front() == '/'; }

}  // namespace

DeviceSpec parseDeviceSpec(const std::string& text, const char* option) {
  const std::size_t end = std::min(text.find_first_of(":@"), text.size());
  const std::string name = text.substr(0, end);
  if (end == text.size()) {
    if (name == "falcon") return {Kind::kFalconUsb, ""};
    if (name == "emulated") return {Kind::kEmulated, ""};
    if (name == "simulated") return {Kind::kSimulated, ""};
    if (name == "spacemouse") return {Kind::kSpaceMouse, ""};
    if (name == "hid") return {Kind::kRawHid, ""};
    if (name == "gamepad") return {Kind::kGamepad, ""};
    refuse(option, text);
  }
  const std::string place = text.substr(end + 1);
  if (text[end] == '@') {
    if (name == "falcon" && place == "ft260") return {Kind::kFalconFt260, ""};
    if (name == "falcon" && isPath(place)) return {Kind::kFalconTty, place};
  } else {
    if (name == "falcon" && !place.empty()) return {Kind::kFalconUsb, place};
    if (name == "spacemouse" && isPath(place)) return {Kind::kSpaceMouse, place};
    if (name == "hid" && isPath(place)) return {Kind::kRawHid, place};
    if (name == "gamepad" && isPath(place)) return {Kind::kGamepad, place};
  }
  refuse(option, text);
}

std::string toText(const DeviceSpec& spec) {
  const auto with = [&](std::string name) {
    return spec.place.empty() ? name : name + ":" + spec.place;
  };
  switch (spec.kind) {
    case Kind::kFalconUsb:
      return with("falcon");
    case Kind::kFalconTty:
      return "falcon@" + spec.place;
    case Kind::kFalconFt260:
      return "falcon@ft260";
    case Kind::kEmulated:
      return "emulated";
    case Kind::kSimulated:
      return "simulated";
    case Kind::kSpaceMouse:
      return with("spacemouse");
    case Kind::kRawHid:
      return with("hid");
    case Kind::kGamepad:
      return with("gamepad");
  }
  return "";
}

}  // namespace tandem::demos
