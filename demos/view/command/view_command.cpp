#include <cstdlib>
#include <memory>
#include <optional>

#include "command/command.h"
#include "command/picture_size_option.h"
#include "command/world_argument.h"
#include "device/device_options.h"
#include "device/open_device.h"
#include "device/user_axes.h"
#include "peer/peer_line.h"
#include "terminal/stop_signals.h"
#include "terminal/usage_error.h"
#include "window/view_run.h"

namespace tandem::demos {
namespace {

/// `tandem view`: a live world in a window.
class ViewCommand final : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.option("WORLD", world_,
                     "a world's name, such as crate (the default), or a scenario file");
    arguments.repeated("--set", settings_.overrides, "override a key, as for tandem run");
    arguments.option("--size", size_, "width and height in pixels, e.g. 1280x800");
    arguments.option("--seconds", settings_.duration, "close after this time");
    arguments.option("--status", status_, "file of a JSON line every 0.1 s");
    arguments.option("--screenshot", screenshot_, "PNG file of the last frame");
    declarePeerLine(arguments, line_, {});
    declareDeviceOptions(arguments, device_);
  }

  ExitStatus run() override {
    // Mesa's software driver would take both cores from the haptic threads.
    setenv("LP_NUM_THREADS", "1", 0);
    settings_.scenario = view::findWorld(world_);
    settings_.size = view::parsePictureSize(size_);
    if (status_) settings_.status = *status_;
    if (screenshot_) settings_.screenshot = *screenshot_;
    if (line_.site != 0 || !line_.peer.empty()) settings_.line = completeLine();
    checkDeviceOptions(device_);
    const StopSignals signals;
    const auto device = device_.device.empty() ? nullptr : openUsersDevice();
    view::ViewRun run(settings_, device.get());
    run.run([&] { return signals.isAskedWithin(0.0); });
    return kDone;
  }

 private:
  [[nodiscard]] const PeerLine& completeLine() const {
    checkPeerLine(line_);
    if (line_.bind.empty() || line_.peer.empty() || line_.key.empty())
      throw UsageError("--site, --bind, --peer and --key belong together: name all four");
    return line_;
  }

  [[nodiscard]] std::unique_ptr<LiveDevice> openUsersDevice() const {
    const Scenario scenario = loadScenario(settings_.scenario, settings_.overrides);
    const SceneFrame frame = makeSceneFrame(scenario);
    const int user = settings_.line ? settings_.line->site - 1 : 0;
    const Vec3 start_W = computeStart(scenario, frame, user);
    auto device =
        openDevice(device_, {computeUserAxes(frame.q_WS, user), start_W}, UserWish::kReach);
    device->holdUntilTicked(start_W);
    return device;
  }

  view::ViewSettings settings_;
  DeviceOptions device_;
  PeerLine line_;
  std::string world_ = "crate", size_ = "1280x800";
  std::optional<std::string> status_, screenshot_;
};

}  // namespace

CommandEntry viewCommand() {
  return {"view", "a live world in a window", 1, makeCommand<ViewCommand>};
}

}  // namespace tandem::demos
