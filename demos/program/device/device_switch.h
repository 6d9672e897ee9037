#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "tandem/falcon/hid_switch.h"

#include "device/drivers.h"

namespace tandem::demos {

/// A switch of a user: a button or a pedal.
struct SwitchSpec {
  std::uint8_t button = 0;  ///< FalconButton or GamepadButton of the device itself; 0: a pedal
  std::string path;         ///< path of the pedal's hidraw node
  HidSwitchMap map;
};

/// "plus", "forward", "centre", "minus": a button of a Falcon's grip. "south", "east", "north",
/// "west", "left", "right": a button or shoulder of a gamepad. Or a pedal:
/// "hid:PATH,KIND,REPORT,BYTE,VALUE", with KIND one of bits, key, usage. Throws UsageError with the
/// allowed values, naming the `option`.
[[nodiscard]] SwitchSpec parseSwitch(const char* option, const std::string& text);

/// A switch in use.
class DeviceSwitch {
 public:
  /// Without a text it is never pressed. Throws as parseSwitch() and HidSwitch do.
  DeviceSwitch(const char* option, const std::optional<std::string>& text);

  /// True while it is pressed; buttons are those of `driver`. Wait-free, for any thread.
  [[nodiscard]] bool isPressed(const Driver& driver) const noexcept;
  /// False without a text.
  [[nodiscard]] bool isThere() const noexcept { return button_ != 0 || pedal_; }

 private:
  std::uint8_t button_ = 0;
  std::unique_ptr<HidSwitch> pedal_;
};

}  // namespace tandem::demos
