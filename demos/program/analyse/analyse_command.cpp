#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analyse/analysis.h"
#include "analyse/loop_of_scenario.h"
#include "analyse/map_options.h"
#include "analyse/stability_atlas.h"
#include "command/command.h"
#include "terminal/standard_output.h"
#include "terminal/status_line.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

/// `tandem analyse`: stability of a scenario's gains, and advice.
class AnalyseCommand final : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.option("scenario", scenario_, "scenario file (TOML)", {.is_required = true});
    arguments.repeated("--set", overrides_, "override a key, as for tandem run");
    arguments.option("--users", users_, "so many users, in place of the scenario's sites");
    arguments.flag("--worst-phase", at_worst_, "judge by the worst phase of packets, and delay");
    arguments.flag("--check", checks_, "end with status 3 if it is unstable");
    arguments.flag("--json", json_, "print JSON");
    arguments.option("--map", map_, "X,Y: growth over two gains, drawn with --out, else as CSV");
    arguments.flag("--figures", draws_all_, "draw maps and curves for all schemes, into --out");
    arguments.option("--points", points_, "of a map, along both sides or NXxNY; 60 if not given");
    arguments.option("--out", out_, "folder for stability.json, map CSV files and figures");
  }

  ExitStatus run() override {
    const auto gains = map_ ? std::optional(parseMapGains(*map_)) : std::nullopt;
    const MapSize size = points_ ? parseMapSize(*points_) : MapSize{};
    const bool draws = gains || draws_all_;
    checkTogether(draws);
    const Scenario scenario = loadScenario(scenario_, overrides_);
    LoopSettings loop = makeLoop(scenario);
    if (users_ && (*users_ < 2 || *users_ > kMaxPeerId))
      throw UsageError(fmt::format("--users {}: must be 2 to {}", *users_, kMaxPeerId));
    if (users_ && !loop.areUsersAlike())
      throw UsageError(
          "--users: the scenario's sites differ; list them as [[site]] in place of it");
    if (users_) loop.users = static_cast<int>(*users_);
    if (!draws) return tell(loop, scenario.network.jitter);
    const double rate = computeWorstRate(loop);  // refuses what cannot be analysed
    const std::string title =
        scenario.title.empty() ? std::filesystem::path(scenario_).stem().string() : scenario.title;
    draw(title, loop, gains, size);
    return checks_ && rate >= 0.0 ? kCheckFailed : kDone;
  }

 private:
  void checkTogether(bool draws) const {
    if (map_ && draws_all_) throw UsageError("--map, --figures: give one of them");
    if (draws_all_ && !out_)
      throw UsageError("--figures: need a folder for their files; give --out FOLDER");
    if (draws && at_worst_)
      throw UsageError("--worst-phase: is not for --map and --figures; leave it out");
    if (!draws && (points_ || out_))
      throw UsageError("--points, --out: are for --map X,Y and --figures; give one of these, too");
  }

  [[nodiscard]] ExitStatus tell(const LoopSettings& loop, double jitter) const {
    const Analysis analysis = analyse(loop, jitter);
    writeOutput(json_ ? toJson(analysis).dump(2) + "\n" : describe(analysis));
    const bool is_stable = at_worst_ ? isStableAtWorst(analysis) : isStable(analysis);
    if (at_worst_ && !json_)
      writeOutput(is_stable ? "Stable at the worst phase and delay.\n"
                            : "Unstable at the worst phase or delay.\n");
    return checks_ && !is_stable ? kCheckFailed : kDone;
  }

  void draw(const std::string& title, const LoopSettings& loop,
            const std::optional<std::pair<LoopGain, LoopGain>>& gains, const MapSize& size) const {
    std::optional<AtlasFolder> folder;
    if (out_) folder.emplace(*out_);
    StabilityAtlas atlas;
    {
      ProgressLine line;
      const auto show = [&line](double share) { line.show("points", share); };
      atlas = gains ? makeMapAtlas(title, loop, *gains, size, show)
                    : makeWholeAtlas(title, loop, size, show);
    }
    std::string text = folder ? folder->write(atlas).string() + "\n" : writeCsv(atlas.maps.front());
    writeOutput(json_ ? writeJson(atlas) : text);
  }

  std::string scenario_;
  std::vector<std::string> overrides_;
  std::optional<std::uint64_t> users_;
  std::optional<std::string> map_, points_, out_;
  bool at_worst_ = false, checks_ = false, json_ = false, draws_all_ = false;
};

}  // namespace

CommandEntry analyseCommand() {
  return {"analyse", "tell before a touch whether gains are stable, and which to turn", 3,
          makeCommand<AnalyseCommand>};
}

}  // namespace tandem::demos
