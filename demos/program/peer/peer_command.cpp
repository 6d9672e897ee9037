#include "peer/peer_command.h"

#include <csignal>
#include <cstdio>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tandem/falcon/monotonic_clock.h"
#include "tandem/plugin/key_file.h"

#include "device/get_ready.h"
#include "device/open_device.h"
#include "device/user_axes.h"
#include "peer/peer_configuration.h"
#include "peer/peer_output.h"
#include "peer/peer_run.h"
#include "run/run_output.h"
#include "terminal/standard_output.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

volatile std::sig_atomic_t stop_asked = 0;

extern "C" void askToStop(int) { stop_asked = 1; }

/// SIGINT and SIGTERM end the run instead of the program; with a device, which must not be left
/// with force, a closed terminal and a closed pipe neither end the program.
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

void print(const PeerReport& report) {
  const PeerStatus& peer = report.peer;
  std::string time = report.has_start ? fmt::format("{:8.1f} s", report.time) : "   waiting";
  // Once it runs, how the states come says more than that the connection stands.
  const bool is_running = report.time > 0.0 && peer.phase == PeerPhase::kLive;
  const std::string_view state = is_running ? nameOf(report.link) : name(peer.phase);
  fmt::print(
      "{} | {:9} | round trip {:6.1f} ms | wait {:5.1f} ms | jitter {:5.1f} ms | loss "
      "{:4.1f} % | force {:6.3f} N | coherency {:7.3f} mm\n",
      time, state, 1e3 * peer.round_trip, 1e3 * peer.wait, 1e3 * peer.jitter, 1e2 * peer.loss,
      report.force, 1e3 * report.coherency);
  std::fflush(stdout);
}

void checkCommand(const PeerCommand& command) {
  if (command.site != 1 && command.site != 2)
    throw UsageError(fmt::format("--site {}: must be 1 or 2", command.site));
  if (!(command.patience > 0.0 && command.patience <= 86400.0))
    throw UsageError("--wait: must be above 0 and at most 86400 s");
}

UdpMeshSettings makeSettings(const PeerCommand& command, const Scenario& scenario) {
  UdpMeshSettings settings;
  settings.self = PeerId{static_cast<std::uint32_t>(command.site)};
  settings.bind = resolveAddress(command.bind);
  settings.profile = command.profile == "float64" ? WireProfile::kFloat64 : WireProfile::kFloat32;
  settings.playout.is_on = command.playout == "on";
  Configuration items = makePeerConfiguration(scenario);
  items.push_back({"wire.profile", command.profile});
  settings.configuration = makeConfiguration(std::move(items));
  return settings;
}

/// The user's own device, ready and where the scenario has the user start; null without --device.
/// `is_ended` if the user would rather end.
std::unique_ptr<LiveDevice> openUsersDevice(const PeerCommand& command, const Scenario& scenario,
                                            bool& is_ended) {
  if (command.device.device.empty()) {
    checkDeviceOptions(command.device);
    return nullptr;
  }
  const SceneFrame frame = makeSceneFrame(scenario);
  const int site = command.site - 1;
  const Vec3 start_W = computeStart(scenario, frame, site);
  auto device =
      openDevice(command.device, {computeUserAxes(frame.q_WS, site), start_W}, UserWish::kReach);
  GetReadySettings settings;
  settings.is_quiet = command.quiet;
  is_ended = !getReady(*device, settings, [](double seconds) {
    sleepFor(seconds);
    return stop_asked != 0;
  });
  // The hand may go where it likes until both sites run.
  device->holdUntilTicked(start_W);
  return device;
}

}  // namespace

void runPeerCommand(const PeerCommand& command) {
  checkCommand(command);
  const Scenario scenario = loadScenario(command.scenario, command.overrides);
  if (command.folder) prepareFolder(*command.folder);
  UdpPeer peer{PeerId{static_cast<std::uint32_t>(3 - command.site)}, resolveAddress(command.peer),
               readKeyFile(command.key)};
  if (!peer.key.isLocked())
    fmt::print(stderr, "tandem: note: the key may be swapped to disk; raise ulimit -l\n");
  catchSignals(!command.device.device.empty());
  bool is_ended = false;
  const auto device = openUsersDevice(command, scenario, is_ended);
  if (is_ended) return;
  PeerRun run(scenario, command.site - 1, makeSettings(command, scenario), std::move(peer),
              device.get());
  const auto stop = [] { return stop_asked != 0; };
  const auto report = [&](const PeerReport& one) {
    if (!command.quiet) print(one);
  };
  if (!command.quiet) fmt::print("site {} on {}\n", command.site, toString(run.peers().bound()));
  if (!run.waitForPeer(command.patience, stop, report)) return;
  run.run(stop, report,
          [](const std::string& note) { fmt::print(stderr, "tandem: note: {}\n", note); });
  const nlohmann::json summary = makePeerSummary(scenario, command.site, run);
  if (command.folder) writePeerRun(*command.folder, command.site, summary, run);
  if (!command.quiet) printPeerSummary(summary, command.site);
  finishOutput();
}

}  // namespace tandem::demos
