#include <fmt/format.h>

#include "device/device_task.h"
#include "device/get_ready.h"
#include "device/open_device.h"
#include "terminal/standard_output.h"

namespace tandem::demos {

void homeDevice(const DeviceTask& task, const Pause& pause) {
  const auto device = openDevice(task.device, placeAlone(), UserWish::kRest);
  const GetReadySettings settings = makeGetReadySettings(task, false);
  if (!getReady(*device, settings, pause)) return;
  const DeviceReport report = device->report();
  if (!task.quiet)
    fmt::print("{}: {}\n", toText(device->spec()),
               report.homed ? "homed; it stays so until its power goes"
                            : "ready; there is nothing to home");
  finishOutput();
}

}  // namespace tandem::demos
