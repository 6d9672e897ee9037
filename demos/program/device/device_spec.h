#pragma once

#include <string>

namespace tandem::demos {

/// The choice of a device, in the one spelling of all commands.
struct DeviceSpec {
  enum class Kind {
    kFalconUsb,    ///< `place`: serial number, empty for the first
    kFalconTty,    ///< `place`: path of the tty
    kFalconFt260,  ///< through the bridge from HID to a serial line
    kEmulated,     ///< a Falcon in this process, byte by byte
    kSimulated,
    kSpaceMouse,  ///< `place`: path of the hidraw node, empty for the first
    kRawHid,      ///< likewise
    kGamepad      ///< `place`: path of the input node, empty for the first
  };
  Kind kind = Kind::kSimulated;
  std::string place;
};

/// Reads "falcon", "falcon:SERIAL", "falcon@/dev/ttyUSB0", "falcon@ft260", "emulated", "simulated",
/// "spacemouse[:PATH]", "hid[:PATH]" or "gamepad[:PATH]". Throws UsageError with the allowed
/// values, naming the `option`.
[[nodiscard]] DeviceSpec parseDeviceSpec(const std::string& text, const char* option = "--device");

/// The spelling of `spec`; inverse of parseDeviceSpec().
[[nodiscard]] std::string toText(const DeviceSpec& spec);

}  // namespace tandem::demos
