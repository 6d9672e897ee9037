#include <csignal>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tandem/falcon/monotonic_clock.h"
#include "tandem/plugin/key_file.h"

#include "analyse/growth_warning.h"
#include "command/command.h"
#include "device/device_options.h"
#include "peer/peer_meeting.h"
#include "peer/peer_output.h"
#include "peer/publishing.h"
#include "peer/report_line.h"
#include "peer/site_values.h"
#include "peer/users_device.h"
#include "peer/watch_run.h"
#include "terminal/standard_output.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

/// Options of `tandem peer`, as written.
struct PeerOptions {
  std::string scenario;
  std::vector<std::string> overrides;
  PeerLine line;
  std::optional<std::string> folder, publish;
  bool quiet = false;
  bool watch = false;
  DeviceOptions device;  ///< without --device: simulated, by the scenario
};

volatile std::sig_atomic_t stop_asked = 0;

extern "C" void askToStop(int) { stop_asked = 1; }

/// SIGINT and SIGTERM end the run instead of the program. A device must not be left with force.
/// With one, a closed terminal and a closed pipe do not end the program either.
void catchSignals(bool has_device) {
  struct sigaction action {};
  action.sa_handler = &askToStop;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  if (!has_device) return;
  sigaction(SIGHUP, &action, nullptr);
  action.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &action, nullptr);
}

PeerWatch makeWatch(const PeerOptions& options) {
  PeerWatch watch;
  watch.stop = [] { return stop_asked != 0; };
  watch.report = [is_quiet = options.quiet](const PeerReport& one) {
    if (is_quiet) return;
    fmt::print("{}\n", describeReport(one));
    std::fflush(stdout);
  };
  watch.note = [](const std::string& note) { fmt::print(stderr, "tandem: note: {}\n", note); };
  return watch;
}

/// A spectator needs none of these.
void checkRequired(const PeerOptions& options) {
  if (options.scenario.empty()) throw UsageError("--scenario is required");
  if (options.line.site == 0) throw UsageError("--site is required");
  if (options.line.isByUdp() && options.line.bind.empty()) throw UsageError("--bind is required");
  if (options.line.keys.empty()) throw UsageError("--key is required");
}

void checkWatching(const PeerOptions& options) {
  if (options.line.site != 0 || !options.line.keys.empty() || !options.line.peers.empty() ||
      !options.device.device.empty() || !options.line.isByUdp())
    throw UsageError(
        "--watch: a spectator has no site and no hand; leave out --site, --peer, --carrier, --key "
        "and --device");
  if (options.scenario.empty() && !options.overrides.empty())
    throw UsageError("--set: needs --scenario, which --watch compares with that of the sites");
}

void watch(const PeerOptions& options) {
  checkWatching(options);
  std::optional<Scenario> scenario;
  if (!options.scenario.empty()) scenario = loadScenario(options.scenario, options.overrides);
  watchSites(options.line, scenario ? &*scenario : nullptr,
             {options.folder, options.publish, options.quiet});
}

/// Null without `--publish`.
std::unique_ptr<SitePublisher> openPublisher(const PeerOptions& options) {
  if (!options.publish) return nullptr;
  return std::make_unique<SitePublisher>(
      makePublisher(*options.publish, "hand, force and objects of this site"),
      PeerId{static_cast<std::uint32_t>(options.line.site)});
}

std::string describePlace(const PeerLine& line, PeerMeeting& meeting) {
  return line.isByUdp() ? toString(meeting.run().peers().bound()) : line.carrier;
}

void runPeer(const PeerOptions& options) {
  const Scenario scenario = loadScenario(options.scenario, options.overrides);
  checkPeerLine(options.line, scenario.sites.size());
  checkGrip(options.device, scenario);
  std::optional<OutputFolder> folder;
  if (options.folder)
    folder.emplace(*options.folder, "--out " + *options.folder, FolderPart{options.line.site});
  // A bad one is told before a device moves.
  for (const std::string& key : options.line.keys) (void)readKeyFile(parseSiteValue(key).value);
  (void)makeRelayAccess(options.line);
  const auto publisher = openPublisher(options);
  catchSignals(!options.device.device.empty());
  bool is_ended = false;
  const auto pause = [](double seconds) {
    sleepFor(seconds);
    return stop_asked != 0;
  };
  const auto device = openUsersDevice(options.device, scenario, options.line.site - 1,
                                      options.quiet, pause, is_ended);
  if (is_ended) return;
  PeerUser user{device.get(), {}, PeerPurpose::kResults, !folder};
  if (device && device->hasGrip()) user.wants_grip = [&] { return device->isGripPressed(); };
  PeerMeeting meeting(scenario, options.line, std::move(user));
  if (!options.quiet) {
    fmt::print("site {} on {}\n", options.line.site, describePlace(options.line, meeting));
    for (const std::string& line : warnBeforeTouch(scenario)) fmt::print("note: {}\n", line);
  }
  PeerWatch watch = makeWatch(options);
  if (publisher)
    watch.after_step = [&](double time, const HapticLoop&) {
      publisher->noteStep(time, meeting.run().world().site());
    };
  if (!meeting.live(watch)) return;
  const nlohmann::json summary = makePeerSummary(meeting.run());
  if (folder) writePeerRun(*folder, options.line.site, summary, meeting.run());
  if (!options.quiet) printPeerSummary(summary, options.line.site);
  finishOutput();
}

/// `tandem peer`: one site of a scenario, live over UDP or another carrier.
class PeerCommand final : public Command {
 public:
  void declare(Arguments& arguments) override {
    PeerOptions& own = options_;
    arguments.option("--scenario", own.scenario, "scenario file (TOML)");
    arguments.repeated("--set", own.overrides, "override a key, as for tandem run");
    declarePeerLine(arguments, own.line);
    arguments.option("--carrier", own.line.carrier,
                     "udp, or dds:DOMAIN on Cyclone DDS in a trusted segment");
    arguments.flag("--watch", own.watch, "follow the sites of a relay's room without a hand");
    arguments.option("--out", own.folder,
                     "folder for siteN.csv, sceneN.csv and siteN.json, or watch.csv");
    arguments.option("--publish", own.publish,
                     "dds:DOMAIN: show hand, force and objects in clear, in a trusted segment");
    declareDeviceOptions(arguments, own.device);
    arguments.flag("--quiet", own.quiet, "print nothing but errors");
  }

  ExitStatus run() override {
    if (options_.watch) {
      watch(options_);
      return kDone;
    }
    checkRequired(options_);
    runPeer(options_);
    return kDone;
  }

 private:
  PeerOptions options_;
};

}  // namespace

CommandEntry peerCommand() {
  return {"peer", "one site of a scenario, live over UDP", 4, makeCommand<PeerCommand>};
}

}  // namespace tandem::demos
