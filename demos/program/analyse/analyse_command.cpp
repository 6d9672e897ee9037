#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analyse/analysis.h"
#include "analyse/loop_of_scenario.h"
#include "command/command.h"
#include "terminal/standard_output.h"
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
    arguments.flag("--check", checks_, "end with status 3 if it is unstable");
    arguments.flag("--json", json_, "print JSON");
  }

  ExitStatus run() override {
    LoopSettings loop = makeLoop(loadScenario(scenario_, overrides_));
    if (users_ && (*users_ < 2 || *users_ > kMaxPeerId))
      throw UsageError(fmt::format("--users {}: must be 2 to {}", *users_, kMaxPeerId));
    if (users_) loop.users = static_cast<int>(*users_);
    const Analysis analysis = analyse(loop);
    writeOutput(json_ ? toJson(analysis).dump(2) + "\n" : describe(analysis));
    return checks_ && !isStable(analysis) ? kCheckFailed : kDone;
  }

 private:
  std::string scenario_;
  std::vector<std::string> overrides_;
  std::optional<std::uint64_t> users_;
  bool checks_ = false, json_ = false;
};

}  // namespace

CommandEntry analyseCommand() {
  return {"analyse", "tell before a touch whether gains are stable, and which to turn", 3,
          makeCommand<AnalyseCommand>};
}

}  // namespace tandem::demos
