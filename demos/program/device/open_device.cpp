#include "device/open_device.h"

#include "device/plugged_in.h"

namespace tandem::demos {
namespace {

DeviceSpec chooseDevice(const DeviceOptions& options) {
  if (!options.device.empty()) return parseDeviceSpec(options.device);
  const std::vector<PluggedIn> found = findPluggedIn();
  if (!found.empty()) return found.front().spec;
  throw Error(
      hasDeviceLibraries()
          ? "no device is plugged in; plug one in, or try --device emulated"
          : "built without devices, so none is found; give --device falcon@/dev/ttyUSB0, or "
            "try --device emulated");
}

}  // namespace

std::unique_ptr<LiveDevice> openDevice(const DeviceOptions& options, const Placement& placement,
                                       UserWish wish) {
  checkDeviceOptions(options);
  if (options.clutch) (void)parseSwitch("--clutch", *options.clutch);
  if (options.grip) (void)parseSwitch("--grip", *options.grip);
  const DeviceSpec spec = chooseDevice(options);
  return std::make_unique<LiveDevice>(spec, openDriver(spec, options, wish), options, placement);
}

}  // namespace tandem::demos
