#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analyse/growth_warning.h"
#include "command/command.h"
#include "import/file_scenario.h"
#include "run/run_output.h"
#include "scenario/scenario.h"
#include "terminal/standard_output.h"
#include "terminal/status_line.h"

namespace tandem::demos {
namespace {

void printSummary(const nlohmann::json& s, std::size_t sites) {
  fmt::print("{:<34}{:>12.3f} mm\n", "coherency error, mean",
             1e3 * s["coherency"]["mean_abs"].get<double>());
  fmt::print("{:<34}{:>12.3f} mm\n", "coherency error, largest",
             1e3 * s["coherency"]["max_abs"].get<double>());
  for (std::size_t number = 1; number <= sites; ++number) {
    const std::string site = fmt::format("site{}", number);
    const nlohmann::json& one = s[site];
    fmt::print("{} force, mean / largest         {:>12.3f} / {:.3f} N\n", site,
               one["force"]["mean"].get<double>(), one["force"]["max"].get<double>());
    fmt::print("{} contact changes, device end   {:>12} , {:.4f} m\n", site,
               one["contact_transitions"].get<int>(), one["device_end"].get<double>());
  }
  fmt::print("state hash {}, {:.0f} times real time\n", s["state_hash"].get<std::string>(),
             s["real_time_factor"].get<double>());
}

/// `tandem run`: all sites of a scenario in virtual time.
class RunCommand final : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.option("scenario", scenario_,
                     "scenario file (TOML), or a .urdf, .xml or .bullet file",
                     {.is_required = true});
    arguments.repeated("--set", overrides_, "override a key, e.g. --set network.delay=0.1");
    arguments.repeated("--share", shares_, "a body of the world's file that both users move");
    arguments.option("--out", folder_, "folder for site1.csv ..., scene.csv, summary.json");
    arguments.flag("--json", json_, "print summary.json to stdout");
    arguments.flag("--quiet", quiet_, "print nothing but errors");
  }

  ExitStatus run() override {
    const Scenario scenario = loadScenario(scenario_, addShares(overrides_, shares_));
    std::optional<OutputFolder> folder;
    if (folder_) folder.emplace(*folder_, "--out " + *folder_);
    VirtualRun run(scenario);
    if (!quiet_ && !json_)
      for (const std::string& line : warnBeforeTouch(scenario)) fmt::print("note: {}\n", line);
    {
      ProgressLine line(quiet_);
      run.run([&](double share) { line.show(fmt::format("of {} s", scenario.duration), share); });
    }
    const nlohmann::json summary = makeSummary(scenario, run);
    if (folder) writeRun(*folder, summary, run);
    print(summary, scenario.sites.size());
    return kDone;
  }

 private:
  void print(const nlohmann::json& summary, std::size_t sites) const {
    if (json_) {
      writeOutput(summary.dump(2) + "\n");
    } else if (!quiet_) {
      printSummary(summary, sites);
    }
    finishOutput();
  }

  std::string scenario_;
  std::vector<std::string> overrides_, shares_;
  std::optional<std::string> folder_;
  bool json_ = false, quiet_ = false;
};

}  // namespace

CommandEntry runCommand() {
  return {"run", "run all sites of a scenario in virtual time", 1, makeCommand<RunCommand>};
}

}  // namespace tandem::demos
