#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "tandem/falcon/hid_switch.h"

namespace tandem::demos {

/// A switch that disconnects the hand from the workspace while pressed.
struct ClutchSpec {
  std::uint8_t button = 0;  ///< a FalconButton on the device itself; 0: a pedal
  std::string path;         ///< path of the pedal's hidraw node
  HidSwitchMap map;
};

/// "plus", "forward", "centre", "minus": a button of a Falcon's grip. Or a pedal:
/// "hid:PATH,KIND,REPORT,BYTE,VALUE", with KIND one of bits, key, usage. Throws UsageError with the
/// allowed values.
[[nodiscard]] ClutchSpec parseClutch(const std::string& text);

}  // namespace tandem::demos
