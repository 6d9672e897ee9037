#include <algorithm>
#include <cstdio>
#include <exception>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tandem/plugin/key_file.h"

#include "bench/accuracy/accuracy_command.h"
#include "bench/speed/speed_command.h"
#include "bench/stress/stress_command.h"
#include "device/command/arguments.h"
#include "link/link_command.h"
#include "peer/peer_command.h"
#include "plot/drawing.h"
#include "run/run_output.h"
#include "run/virtual_run.h"
#include "scenario/scenario.h"
#include "terminal/standard_output.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

constexpr int kDone = 0, kFailed = 1, kBadUse = 2, kCheckFailed = 3;

struct RunOptions {
  std::string scenario;
  std::vector<std::string> overrides;
  std::optional<std::string> folder;
  bool json = false;
  bool quiet = false;
};

void printSummary(const nlohmann::json& s) {
  fmt::print("{:<34}{:>12.3f} mm\n", "coherency error, mean",
             1e3 * s["coherency"]["mean_abs"].get<double>());
  fmt::print("{:<34}{:>12.3f} mm\n", "coherency error, largest",
             1e3 * s["coherency"]["max_abs"].get<double>());
  for (const char* site : {"site1", "site2"}) {
    const nlohmann::json& one = s[site];
    fmt::print("{} force, mean / largest         {:>12.3f} / {:.3f} N\n", site,
               one["force"]["mean"].get<double>(), one["force"]["max"].get<double>());
    fmt::print("{} contact changes, device end   {:>12} , {:.4f} m\n", site,
               one["contact_transitions"].get<int>(), one["device_end"].get<double>());
  }
  fmt::print("state hash {}, {:.0f} times real time\n", s["state_hash"].get<std::string>(),
             s["real_time_factor"].get<double>());
}

int runScenario(const RunOptions& options) {
  const Scenario scenario = loadScenario(options.scenario, options.overrides);
  if (options.folder) prepareFolder(*options.folder);

  VirtualRun run(scenario);
  const bool shows_progress = !options.quiet && isatty(STDERR_FILENO);
  run.run([&](double share) {
    if (shows_progress) fmt::print(stderr, "\r{:3.0f} % of {} s", 100.0 * share, scenario.duration);
  });
  if (shows_progress) fmt::print(stderr, "\r\033[K");

  const nlohmann::json summary = makeSummary(scenario, run);
  if (options.folder) writeRun(*options.folder, summary, run);
  if (options.json) {
    writeOutput(summary.dump(2) + "\n");
  } else if (!options.quiet) {
    printSummary(summary);
  }
  finishOutput();
  return kDone;
}

int makeKey(const std::string& path) {
  makeKeyFile(path);
  fmt::print("{}: a new key; copy it to the other site by a way that nobody reads along\n", path);
  finishOutput();
  return kDone;
}

CLI::App* addLinkCommand(CLI::App& app, LinkCommand& options) {
  CLI::App* link = app.add_subcommand("link", "a bad network between two programs, by UDP");
  link->add_option("--listen", options.listen, "the client sends here; host:port or :port")
      ->required();
  link->add_option("--forward", options.forward, "the server, host:port")->required();
  link->add_option("--delay", options.delay, "one way, such as 50ms");
  link->add_option("--jitter", options.jitter, "the delay is even in delay +- jitter");
  link->add_option("--loss", options.loss, "so many never arrive, such as 2%");
  link->add_option("--duplicate", options.duplicate, "so many arrive twice");
  link->add_option("--reorder", options.reorder, "so many jump the queue, without delay");
  link->add_option("--corrupt", options.corrupt, "in so many one bit is turned");
  link->add_flag("--keep-order", options.keep_order, "jitter lets none overtake another");
  link->add_option("--seed", options.seed, "another seed, other fates");
  link->add_option("--script", options.script, "changes over time (TOML)");
  link->add_option("--for", options.duration, "end after so many seconds");
  link->add_flag("--json", options.json, "print the report as JSON to stdout");
  link->add_flag("--quiet", options.quiet, "print nothing but errors");
  return link;
}

int runProgram(int argc, char** argv) {
  CLI::App app{"Tandem: networked haptic cooperation in Bullet Physics by remote dynamic proxies.",
               "tandem"};
  app.require_subcommand(0, 1);

  RunOptions run_options;
  CLI::App* run = app.add_subcommand("run", "run all sites of a scenario in virtual time");
  run->add_option("scenario", run_options.scenario, "scenario file (TOML)")->required();
  run->add_option("--set", run_options.overrides, "override a key, e.g. --set network.delay=0.1")
      ->allow_extra_args(false)
      ->take_all();
  run->add_option("--out", run_options.folder,
                  "folder for site1.csv, site2.csv, scene.csv, summary.json");
  run->add_flag("--json", run_options.json, "print summary.json to stdout");
  run->add_flag("--quiet", run_options.quiet, "print nothing but errors");

  std::vector<std::string> plot_folders;
  CLI::App* plot =
      app.add_subcommand("plot", "figures and report.html of one run, or of several compared");
  plot->add_option("folders", plot_folders, "folders of runs; the report goes into the first")
      ->required();

  bench::AccuracyCommand accuracy_options;
  CLI::App* bench = app.add_subcommand("bench", "measure on this machine");
  bench->require_subcommand(1, 1);
  CLI::App* accuracy = bench->add_subcommand(
      "accuracy", "run time against error of the plugin and of other ways to simulate");
  accuracy->add_flag("--json", accuracy_options.json, "print accuracy.json to stdout");
  accuracy->add_flag("--quick", accuracy_options.quick,
                     "fewer host rates and repeats, coarser references");
  accuracy
      ->add_option("--scene", accuracy_options.scenes,
                   "only this scene; may be given several times")
      ->allow_extra_args(false)
      ->take_all();
  accuracy->add_option("--out", accuracy_options.folder,
                       "folder for accuracy.json, accuracy.svg, accuracy.png");

  bench::SpeedCommand speed_options;
  CLI::App* speed = bench->add_subcommand(
      "speed", "run time against bodies of the host and shared objects, and what it should be");
  speed->add_flag("--json", speed_options.json, "print speed.json to stdout");
  speed->add_flag("--quick", speed_options.quick, "fewer worlds, shorter and fewer repeats");
  speed->add_option("--out", speed_options.folder, "folder for speed.json, speed.svg, speed.png");

  bench::StressCommand stress_options;
  CLI::App* stress = bench->add_subcommand(
      "stress", "energy account of thousands of scenes with absurd numbers; exit 3 if one fails");
  stress->add_flag("--json", stress_options.json, "print stress.json to stdout");
  stress->add_flag("--quick", stress_options.quick, "1000 cases, a coarser map");
  stress->add_option("--cases", stress_options.cases, "so many cases");
  stress->add_option("--seed", stress_options.seed, "another seed, other cases");
  stress->add_option("--case", stress_options.one, "this case alone, with its account");
  stress->add_option("--out", stress_options.folder,
                     "folder for stress.json, stability.svg, stability.png");

  LinkCommand link_options;
  CLI::App* link = addLinkCommand(app, link_options);

  DeviceCommand device_options;
  CLI::App* device = addDeviceCommand(app, device_options);

  PeerCommand peer_options;
  CLI::App* peer = app.add_subcommand("peer", "one site of a scenario, live over UDP");
  peer->add_option("--scenario", peer_options.scenario, "scenario file (TOML)")->required();
  peer->add_option("--set", peer_options.overrides, "override a key, as for tandem run")
      ->allow_extra_args(false)
      ->take_all();
  peer->add_option("--site", peer_options.site, "which site this is: 1 or 2")->required();
  peer->add_option("--bind", peer_options.bind, "own address, e.g. :7001")->required();
  peer->add_option("--peer", peer_options.peer, "the other site's address, e.g. host:7002")
      ->required();
  peer->add_option("--key", peer_options.key, "key file that both sites share")->required();
  peer->add_option("--out", peer_options.folder, "folder for siteN.csv and siteN.json");
  peer->add_option("--wait", peer_options.patience, "seconds to wait for the other site");
  peer->add_option("--playout", peer_options.playout,
                   "on: jitter becomes constant delay; off: states are applied as they come")
      ->check(CLI::IsMember({"on", "off"}));
  peer->add_option("--wire", peer_options.profile, "width of numbers on the way")
      ->check(CLI::IsMember({"float32", "float64"}));
  addDeviceOptions(*peer, peer_options.device);
  peer->add_flag("--quiet", peer_options.quiet, "print nothing but errors");

  std::string key_path;
  CLI::App* key = app.add_subcommand("key", "keys that two sites share");
  key->require_subcommand(1, 1);
  CLI::App* new_key = key->add_subcommand("new", "write a new random key into a file of your own");
  new_key->add_option("file", key_path, "a name that is not there yet")->required();

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    if (app.get_subcommands().empty() && !app.remaining().empty())
      throw UsageError(app.remaining().front() +
                       ": no such command; allowed: run, plot, bench, peer, link, device, key; see "
                       "tandem --help");
    throw UsageError(fmt::format("{}; see tandem --help", error.what()));
  }
  if (app.get_subcommands().empty())
    throw UsageError(
        "a command is missing; allowed: run, plot, bench, peer, link, device, key; see tandem "
        "--help");
  if (run->parsed()) return runScenario(run_options);
  if (new_key->parsed()) return makeKey(key_path);
  if (peer->parsed()) {
    runPeerCommand(peer_options);
    return kDone;
  }
  if (device->parsed()) return runDeviceCommand(*device, device_options) ? kDone : kCheckFailed;
  if (link->parsed()) {
    runLinkCommand(link_options);
    return kDone;
  }
  if (accuracy->parsed()) {
    bench::runAccuracyCommand(accuracy_options);
    return kDone;
  }
  if (speed->parsed()) {
    bench::runSpeedCommand(speed_options);
    return kDone;
  }
  if (stress->parsed()) return bench::runStressCommand(stress_options) ? kDone : kCheckFailed;
  return plotRuns(plot_folders);
}

/// One line, whatever file names and values are quoted in it.
int reportError(std::string message, int status) {
  std::replace_if(
      message.begin(), message.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; },
      ' ');
  std::fprintf(stderr, "tandem: %s\n", message.c_str());
  return status;
}

}  // namespace
}  // namespace tandem::demos

int main(int argc, char** argv) {
  using namespace tandem::demos;
  try {
    return runProgram(argc, argv);
  } catch (const UsageError& error) {
    return reportError(error.what(), kBadUse);
  } catch (const std::invalid_argument& error) {
    return reportError(error.what(), kBadUse);
  } catch (const std::exception& error) {
    return reportError(error.what(), kFailed);
  }
}
