#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "tandem/falcon/hid_switch.h"

namespace tandem::demos {

/// What lets a workspace slip while it is pressed.
struct ClutchSpec {
  std::uint8_t button = 0;  ///< of FalconButton, on the device itself; 0: a pedal
  std::string path;         ///< of the pedal's hidraw node
  HidSwitchMap map;
};

/// "plus", "forward", "centre", "minus": a button of a Falcon's grip. Or a pedal:
/// "hid:PATH,KIND,REPORT,BYTE,VALUE", KIND one of bits, key, usage. Throws UsageError, with what is
/// allowed.
[[nodiscard]] ClutchSpec parseClutch(const std::string& text);

}  // namespace tandem::demos
