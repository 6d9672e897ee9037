#include "device/gamepad_driver.h"

#include <utility>

#include "tandem/falcon/gamepad_device.h"

namespace tandem::demos {
namespace {

const char* nameOf(Feel feel) {
  switch (feel) {
    case Feel::kRumble:
      return "rumble";
    case Feel::kForce:
      return "force on the stick";
    case Feel::kNothing:
      break;
  }
  return "no force feedback";
}

DeviceReport describe(const GamepadStatus& status) {
  DeviceReport report = describePlugged(status);
  report.counters = {{"reports", status.counters.reports},
                     {"dropped", status.counters.dropped},
                     {"uploads", status.counters.uploads},
                     {"refused", status.counters.refused},
                     {"losses", status.counters.losses}};
  return report;
}

}  // namespace

PluggedIn toPluggedIn(const GamepadAddress& address) {
  std::string text = "gamepad, " + address.name + ", " + nameOf(address.feel);
  if (!address.may_open) text += std::string("; no right to open it: ") + kGamepadRights;
  return {{DeviceSpec::Kind::kGamepad, address.path}, std::move(text)};
}

std::vector<PluggedIn> findPluggedGamepads() {
  std::vector<PluggedIn> found;
  for (const GamepadAddress& one : findGamepads()) found.push_back(toPluggedIn(one));
  return found;
}

Driver makeGamepadDriver(EventOpener open, const DeviceOptions& options) {
  GamepadSettings settings;
  settings.max_force = options.max_force;
  auto device = std::make_unique<GamepadDevice>(std::move(open), settings);
  Driver driver;
  driver.report = [gamepad = device.get()] { return describe(gamepad->status()); };
  driver.pressed = [gamepad = device.get()] {
    return static_cast<std::uint8_t>(gamepad->buttons());
  };
  driver.usual_grip = "south";
  driver.device = std::move(device);
  return driver;
}

}  // namespace tandem::demos
