#include "device/plugged_in.h"

#include <utility>

#include <fmt/format.h>

#include "tandem/coordination/types.h"

#include "device/gamepad_driver.h"

#ifdef TANDEM_HAS_DEVICES
#include "tandem/falcon/byte_transport.h"
#include "tandem/falcon/hid_port.h"
#include "tandem/falcon/raw_hid_device.h"
#include "tandem/falcon/space_mouse_device.h"
#endif

namespace tandem::demos {

using Kind = DeviceSpec::Kind;

#ifdef TANDEM_HAS_DEVICES

bool hasDeviceLibraries() noexcept { return true; }

std::vector<PluggedIn> findPluggedIn() {
  std::vector<PluggedIn> found;
  for (const FtdiAddress& one : findFtdi())
    found.push_back({{Kind::kFalconUsb, one.serial},
                     one.serial.empty()
                         ? "Novint Falcon; no right to open it: install the udev rule"
                         : "Novint Falcon, serial " + one.serial});
  for (const HidAddress& one : findHid(kRawHid))
    found.push_back({{Kind::kRawHid, one.path}, "raw HID device, " + toText(one)});
  for (const HidAddress& one : findHid(kFt260))
    found.push_back({{Kind::kFalconFt260, ""}, "FT260 bridge, " + toText(one)});
  for (const HidAddress& one : findSpaceMice())
    found.push_back({{Kind::kSpaceMouse, one.path}, "SpaceMouse, " + toText(one)});
  for (PluggedIn& one : findPluggedGamepads()) found.push_back(std::move(one));
  return found;
}

std::unique_ptr<ByteTransport> openFalconUsb(const std::string& serial) {
  FtdiAddress address;
  address.serial = serial;
  return openFtdi(address);
}

std::unique_ptr<ByteTransport> openFalconFt260() { return openHidUart(); }
std::unique_ptr<HidPort> openMouse(const std::string& path) { return openSpaceMouse(path); }

std::unique_ptr<HidPort> openRawHid(const std::string& path) {
  HidAddress address = kRawHid;
  address.path = path;
  return openHid(address);
}

std::unique_ptr<HidPort> openHidPath(const std::string& path) {
  HidAddress address;
  address.path = path;
  return openHid(address);
}

#else

namespace {

[[noreturn]] void refuse(const char* what) {
  throw Error(fmt::format(
      "{} cannot be reached: built without devices; configure with TANDEM_WITH_DEVICES=ON", what));
}

}  // namespace

bool hasDeviceLibraries() noexcept { return false; }
std::vector<PluggedIn> findPluggedIn() { return findPluggedGamepads(); }
std::unique_ptr<ByteTransport> openFalconUsb(const std::string&) { refuse("a Falcon on USB"); }
std::unique_ptr<ByteTransport> openFalconFt260() { refuse("an FT260"); }
std::unique_ptr<HidPort> openMouse(const std::string&) { refuse("a SpaceMouse"); }
std::unique_ptr<HidPort> openRawHid(const std::string&) { refuse("a raw HID device"); }
std::unique_ptr<HidPort> openHidPath(const std::string&) { refuse("a HID device"); }

#endif

}  // namespace tandem::demos
