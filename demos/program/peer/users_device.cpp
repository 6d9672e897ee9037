#include "peer/users_device.h"

#include <string>

#include "device/device_options.h"
#include "device/get_ready.h"
#include "device/open_device.h"
#include "device/user_axes.h"
#include "terminal/usage_error.h"
#include "world/scene.h"

namespace tandem::demos {

void checkGrip(const DeviceOptions& options, const Scenario& scenario) {
  if (!options.grip) return;
  if (options.device.empty())
    throw UsageError("--grip: needs --device; a simulated hand holds things by siteN.grips");
  if (!scenario.mayGrip()) throw UsageError(std::string("--grip: ") + kGripNeeds);
}

std::unique_ptr<LiveDevice> openUsersDevice(const DeviceOptions& options, const Scenario& scenario,
                                            int site, bool is_quiet, const Pause& pause,
                                            bool& is_ended) {
  if (options.device.empty()) {
    checkDeviceOptions(options);
    return nullptr;
  }
  const SceneFrame frame = makeSceneFrame(scenario);
  const Vec3 start_W = computeStart(scenario, frame, site);
  auto device = openDevice(options, {computeUserAxes(frame.q_WS, site), start_W}, UserWish::kReach);
  GetReadySettings settings;
  settings.is_quiet = is_quiet;
  is_ended = !getReady(*device, settings, pause);
  // The hand may move freely until both sites run.
  device->holdUntilTicked(start_W);
  return device;
}

}  // namespace tandem::demos
