#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command/command.h"
#include "command/picture_size_option.h"
#include "command/user_option.h"
#include "command/world_argument.h"
#include "device/device_options.h"
#include "device/device_spec.h"
#include "import/file_scenario.h"
#include "peer/peer_line.h"
#include "peer/users_device.h"
#include "terminal/stop_signals.h"
#include "terminal/usage_error.h"
#include "window/replay_run.h"
#include "window/spectator_run.h"
#include "window/view_run.h"

namespace tandem::demos {
namespace {

constexpr const char* kUsualWorld = "crate";

/// `tandem view`: a live world in a window, or a recorded run.
class ViewCommand final : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.option(
        "WORLD", world_,
        "a world's name, such as crate (the default), or a file: scenario, .urdf, .xml "
        "(MJCF), .bullet");
    arguments.option("--replay", replay_,
                     "folder of a recorded run to show instead; --site 2: as user 2");
    arguments.repeated("--set", overrides_, "override a key, as for tandem run");
    arguments.repeated("--share", shares_, "a body of the world's file that both users move");
    arguments.option("--record", record_,
                     "folder for a record of what you do; after a change FOLDER-2, FOLDER-3");
    arguments.option("--size", size_, "width and height in pixels, e.g. 1280x800");
    arguments.option("--seconds", settings_.window.duration, "close after this time");
    arguments.option("--status", status_, "file of a JSON line every 0.1 s");
    arguments.option("--screenshot", screenshot_, "PNG file of the last frame");
    declarePeerLine(arguments, line_);
    declareDeviceOptions(arguments, device_);
    arguments.flag("--watch", watches_,
                   "without a hand: your user moves as the scenario says; with --relay and "
                   "--watch-key, but no --site: follow the users of its room");
    arguments.option("--second", second_,
                     "user 2's device at this machine: as --device, with its firmware and limits");
  }

  ExitStatus run() override {
    // Mesa's software driver would take both cores from the haptic threads.
    setenv("LP_NUM_THREADS", "1", 0);
    settings_.window.size = view::parsePictureSize(size_);
    if (status_) settings_.window.status = *status_;
    if (screenshot_) settings_.window.screenshot = *screenshot_;
    if (replay_) {
      showReplay();
    } else if (isSpectator()) {
      showRoom();
    } else {
      showSession();
    }
    return kDone;
  }

 private:
  void showReplay() {
    if (!line_.peers.empty() || !line_.relay.empty() || !device_.device.empty() ||
        !overrides_.empty() || !shares_.empty() || !world_.empty() || record_ || second_)
      throw UsageError(
          "--replay: shows what was recorded; leave WORLD and all options but the window's and "
          "--site");
    view::RunReplay replay(view::loadRecordedRun(*replay_), view::chooseUser(line_.site));
    const StopSignals signals;
    view::ReplayRun run(settings_.window, replay);
    run.run([&] { return signals.isAskedWithin(0.0); });
  }

  /// With --site, --watch is a player without a hand.
  [[nodiscard]] bool isSpectator() const {
    return watches_ && line_.site == 0 && !(line_.relay.empty() && line_.watch_key.empty());
  }

  void showRoom() {
    if (!line_.peers.empty() || !line_.keys.empty() || !device_.device.empty() || record_ ||
        second_)
      throw UsageError(
          "--watch: a spectator has no site and no hand; leave out --peer, --key, --device, "
          "--second and --record");
    const StopSignals signals;
    view::SpectatorRun run(settings_.window, loadWorld(), line_);
    run.run([&] { return signals.isAskedWithin(0.0); });
  }

  [[nodiscard]] Scenario loadWorld() const {
    return loadScenario(view::findWorld(world_.empty() ? kUsualWorld : world_),
                        addShares(overrides_, shares_));
  }

  void showSession() {
    settings_.scenario = loadWorld();
    if (record_) settings_.record = *record_;
    if (line_.site != 0 || !line_.peers.empty() || !line_.relay.empty())
      settings_.line = completeLine();
    if (watches_) leaveHand();
    checkGrip(device_, settings_.scenario);
    checkSecond();
    const StopSignals signals;
    bool is_ended = false;
    const auto pause = [&](double seconds) { return signals.isAskedWithin(seconds); };
    const auto device = openUsersDevice(device_, settings_.scenario, view::userOf(settings_.line),
                                        false, pause, is_ended);
    if (is_ended) return;
    std::unique_ptr<LiveDevice> second;
    if (second_)
      second = openSecondDevice(makeSecondOptions(), settings_.scenario, false, pause, is_ended);
    if (is_ended) return;
    view::ViewRun run(settings_, {device.get(), second.get()});
    run.run([&] { return signals.isAskedWithin(0.0); });
  }

  void leaveHand() {
    if (!device_.device.empty())
      throw UsageError("--watch: nobody has a hand then; leave --device or --watch");
    device_.device = "simulated";
  }

  /// Before any device moves.
  void checkSecond() const {
    if (!second_) return;
    if (settings_.line)
      throw UsageError("--second: user 2 is at another machine; leave --second or --site");
    using Kind = DeviceSpec::Kind;
    const Kind kind = parseDeviceSpec(*second_, "--second").kind;
    const bool is_made = kind == Kind::kEmulated || kind == Kind::kSimulated;
    if (*second_ == device_.device && !is_made)
      throw UsageError("--second " + *second_ +
                       ": is user 1's device; name each by its serial number or path, which "
                       "tandem device list says");
  }

  /// Buttons and the workspace's place are those of user 1's device alone.
  [[nodiscard]] DeviceOptions makeSecondOptions() const {
    DeviceOptions options = device_;
    options.device = *second_;
    options.clutch.reset();
    options.grip.reset();
    options.offset.clear();
    return options;
  }

  [[nodiscard]] const PeerLine& completeLine() const {
    const bool has_way = !line_.peers.empty() || !line_.relay.empty();
    if (line_.site == 0 || line_.bind.empty() || line_.keys.empty() || !has_way)
      throw UsageError(
          "--site, --bind, --key and --peer or --relay belong together; a spectator has no --site");
    checkPeerLine(line_, settings_.scenario.sites.size());
    return line_;
  }

  view::ViewSettings settings_;
  DeviceOptions device_;
  PeerLine line_;
  std::vector<std::string> overrides_, shares_;
  std::string world_, size_ = "1280x800";
  bool watches_ = false;
  std::optional<std::string> replay_, record_, second_, status_, screenshot_;
};

}  // namespace

CommandEntry viewCommand() {
  return {"view", "a live world or a recorded run in a window", 1, makeCommand<ViewCommand>};
}

}  // namespace tandem::demos
