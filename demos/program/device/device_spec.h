#pragma once

#include <string>

namespace tandem::demos {

/// Which device is meant, in the one spelling that all commands share.
struct DeviceSpec {
  enum class Kind {
    kFalconUsb,    ///< `place`: serial number, empty for the first
    kFalconTty,    ///< `place`: path of the tty
    kFalconFt260,  ///< behind the bridge from HID to a serial line
    kEmulated,     ///< a Falcon in this process, byte by byte
    kSimulated,
    kSpaceMouse,  ///< `place`: path of the hidraw node, empty for the first
    kRawHid       ///< likewise
  };
  Kind kind = Kind::kSimulated;
  std::string place;
};

/// "falcon", "falcon:SERIAL", "falcon@/dev/ttyUSB0", "falcon@ft260", "emulated", "simulated",
/// "spacemouse[:PATH]", "hid[:PATH]". Throws UsageError, with what is allowed.
[[nodiscard]] DeviceSpec parseDeviceSpec(const std::string& text);

/// The same, back.
[[nodiscard]] std::string toText(const DeviceSpec& spec);

}  // namespace tandem::demos
