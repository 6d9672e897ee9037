#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tandem/falcon/byte_transport.h"
#include "tandem/falcon/hid_port.h"

#include "device/device_spec.h"

/// \file
/// Functions that need libftdi1 and hidapi. A program built without these finds gamepads only, and
/// opening others throws a tandem::Error that explains it.
namespace tandem::demos {

struct PluggedIn {
  DeviceSpec spec;
  std::string text;  ///< "Novint Falcon, serial FPNM0FB"
};

/// Devices plugged in now, by preference: the first is chosen.
[[nodiscard]] std::vector<PluggedIn> findPluggedIn();

/// False if built without libftdi1 and hidapi.
[[nodiscard]] bool hasDeviceLibraries() noexcept;

[[nodiscard]] std::unique_ptr<ByteTransport> openFalconUsb(const std::string& serial);
[[nodiscard]] std::unique_ptr<ByteTransport> openFalconFt260();
[[nodiscard]] std::unique_ptr<HidPort> openMouse(const std::string& path);
[[nodiscard]] std::unique_ptr<HidPort> openRawHid(const std::string& path);
/// Opens any HID interface, for a pedal.
[[nodiscard]] std::unique_ptr<HidPort> openHidPath(const std::string& path);

}  // namespace tandem::demos
