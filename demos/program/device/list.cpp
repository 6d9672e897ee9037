#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "device/device_task.h"
#include "device/plugged_in.h"
#include "terminal/standard_output.h"

namespace tandem::demos {

void listDevices(const DeviceTask& task) {
  std::vector<PluggedIn> devices = findPluggedIn();
  const bool has_none = devices.empty();
  devices.push_back({{DeviceSpec::Kind::kEmulated, ""},
                     "a Falcon in this process, byte by byte, homed by itself"});
  devices.push_back({{DeviceSpec::Kind::kSimulated, ""}, "a mass in a simulated hand"});

  if (task.json) {
    nlohmann::json j = {{"built_with_devices", hasDeviceLibraries()},
                        {"plugged_in", devices.size() - 2},
                        {"devices", nlohmann::json::array()}};
    for (const PluggedIn& one : devices)
      j["devices"].push_back({{"device", toText(one.spec)}, {"text", one.text}});
    writeOutput(j.dump(2) + "\n");
    return;
  }
  if (!hasDeviceLibraries()) fmt::print("built without devices: USB and HID are not looked at\n");
  if (has_none && hasDeviceLibraries()) fmt::print("nothing is plugged in\n");
  for (const PluggedIn& one : devices) fmt::print("{:<24} {}\n", toText(one.spec), one.text);
  finishOutput();
}

}  // namespace tandem::demos
