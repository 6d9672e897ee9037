#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tandem/falcon/byte_transport.h"
#include "tandem/falcon/hid_port.h"

#include "device/device_spec.h"

/// \file
/// What needs libftdi1 and hidapi. A program that was built without them finds nothing, and opening
/// throws tandem::Error that says so.
namespace tandem::demos {

struct PluggedIn {
  DeviceSpec spec;
  std::string text;  ///< "Novint Falcon, serial FPNM0FB"
};

/// Devices that are plugged in now, in the order in which the first is chosen.
[[nodiscard]] std::vector<PluggedIn> findPluggedIn();

/// False: built without libftdi1 and hidapi.
[[nodiscard]] bool hasDeviceLibraries() noexcept;

[[nodiscard]] std::unique_ptr<ByteTransport> openFalconUsb(const std::string& serial);
[[nodiscard]] std::unique_ptr<ByteTransport> openFalconFt260();
[[nodiscard]] std::unique_ptr<HidPort> openMouse(const std::string& path);
[[nodiscard]] std::unique_ptr<HidPort> openRawHid(const std::string& path);
/// Any HID interface, for a pedal.
[[nodiscard]] std::unique_ptr<HidPort> openHidPath(const std::string& path);

}  // namespace tandem::demos
