#include "device/device_options.h"

#include <cmath>

#include <fmt/format.h>

#include "command/arguments.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

void require(bool holds, const char* option, double value, const char* allowed) {
  if (!holds) throw UsageError(fmt::format("{} {}: must be {}", option, value, allowed));
}

}  // namespace

void declareDeviceOptions(Arguments& arguments, DeviceOptions& options) {
  arguments.option("--device", options.device,
                   "falcon, falcon:SERIAL, falcon@/dev/ttyUSB0, falcon@ft260, emulated, simulated, "
                   "spacemouse[:PATH], hid[:PATH], gamepad[:PATH]");
  arguments.option("--firmware", options.firmware,
                   "file of the Falcon's image; none comes with us");
  arguments.option("--motors-per-torque", options.motors_per_torque,
                   "what a Falcon's motors make of a torque [1/(N m)], 4200");
  arguments.option("--max-force", options.max_force, "no more than this at the hand [N], 8");
  arguments.option("--scale", options.scale, "way in the world by way of the hand, 1");
  arguments.triple("--offset", options.offset, "moves the workspace in the world: x y z [m]");
  arguments.option("--clutch", options.clutch,
                   "while pressed the hand goes back alone: plus, forward, centre, minus; on a "
                   "gamepad south, east, north, west, left, right; or "
                   "hid:PATH,KIND,REPORT,BYTE,VALUE");
  arguments.option(
      "--grip", options.grip,
      "while pressed the hand holds the cube that it touches: as --clutch; on a gamepad "
      "south without it");
}

void checkDeviceOptions(const DeviceOptions& options) {
  require(options.motors_per_torque > 0.0 && options.motors_per_torque <= 1e5,
          "--motors-per-torque", options.motors_per_torque, "above 0 and at most 1e5 [1/(N m)]");
  require(options.max_force > 0.0 && options.max_force <= 8.0, "--max-force", options.max_force,
          "above 0 and at most 8 [N]");
  require(options.scale >= 0.01 && options.scale <= 100.0, "--scale", options.scale,
          "0.01 to 100: way in the world by way of the hand");
  for (const double one : options.offset)
    require(std::abs(one) <= 10.0, "--offset", one, "at most 10 each way [m]");
}

}  // namespace tandem::demos
