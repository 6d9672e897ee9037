#include "peer/users_device.h"

#include <string>

#include "device/device_options.h"
#include "device/device_spec.h"
#include "device/get_ready.h"
#include "device/open_device.h"
#include "device/user_axes.h"
#include "terminal/usage_error.h"
#include "world/scene.h"

namespace tandem::demos {
namespace {

/// Users of one machine, who look at one picture, have the axes of one site.
std::unique_ptr<LiveDevice> openFor(int user, int axes_site, const DeviceOptions& options,
                                    const Scenario& scenario, bool is_quiet, const Pause& pause,
                                    bool& is_ended) {
  const SceneFrame frame = makeSceneFrame(scenario);
  const Vec3 start_W = computeStart(scenario, frame, user);
  auto device =
      openDevice(options, {computeUserAxes(frame.q_WS, axes_site), start_W}, UserWish::kReach);
  GetReadySettings settings;
  settings.is_quiet = is_quiet;
  is_ended = !getReady(*device, settings, pause);
  // The hand may move freely until both sites run.
  device->holdUntilTicked(start_W);
  return device;
}

bool hasFalconsButtons(const DeviceOptions& options) {
  using Kind = DeviceSpec::Kind;
  const Kind kind = parseDeviceSpec(options.device).kind;
  return kind == Kind::kFalconUsb || kind == Kind::kFalconTty || kind == Kind::kFalconFt260 ||
         kind == Kind::kEmulated;
}

}  // namespace

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
  return openFor(site, site, options, scenario, is_quiet, pause, is_ended);
}

std::unique_ptr<LiveDevice> openSecondDevice(DeviceOptions options, const Scenario& scenario,
                                             bool is_quiet, const Pause& pause, bool& is_ended) {
  if (!options.grip && hasFalconsButtons(options)) options.grip = "centre";
  return openFor(1, 0, options, scenario, is_quiet, pause, is_ended);
}

}  // namespace tandem::demos
