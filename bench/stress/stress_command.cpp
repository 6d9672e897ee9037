#include <algorithm>
#include <cstdint>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/program/result_output.h"
#include "bench/stress/stress.h"
#include "bench/stress/stress_report.h"
#include "demos/program/command/command.h"
#include "demos/program/terminal/standard_output.h"
#include "demos/program/terminal/status_line.h"
#include "demos/program/terminal/usage_error.h"

namespace tandem::demos {
namespace {

using namespace bench;

constexpr std::uint64_t kCases = 20000, kQuickCases = 1000, kMostCases = 10000000;

/// For so many other cases there is one of bodies in joints.
constexpr std::uint64_t kCasesPerJoined = 20;

/// Approximate number of printed rows of an account.
constexpr std::size_t kRows = 40;

void printAccount(const std::vector<AccountRow>& rows) {
  fmt::print("{:>12}{:>13}{:>13}{:>13}{:>13}{:>13}{:>13}{:>13}{:>13}{:>13}\n", "time", "motion",
             "couplers", "contacts", "weight", "by targets", "by hand", "by host", "push-out",
             "lost");
  const std::size_t stride = std::max<std::size_t>(1, rows.size() / kRows);
  for (std::size_t i = 0; i < rows.size(); i += stride) {
    const AccountRow& row = rows[i];
    fmt::print(
        "{:>12.7f}{:>13.5g}{:>13.5g}{:>13.5g}{:>13.5g}{:>13.5g}{:>13.5g}{:>13.5g}{:>13.5g}{:>13.5g}"
        "\n",
        row.time, row.stock.motion, row.stock.couplers, row.stock.contacts, row.stock.weight,
        row.flows.target_jumps + row.flows.target_motion, row.flows.hand, row.flows.host,
        row.flows.push_out, row.lost);
  }
}

void printCase(const StressCase& one, const StressOutcome& outcome,
               const std::vector<std::vector<AccountRow>>& accounts) {
  fmt::print("{}", describeCase(one));
  for (std::size_t s = 0; s < accounts.size(); ++s) {
    fmt::print("\nenergy at site {} [s, J]\n", s + 1);
    printAccount(accounts[s]);
  }
  fmt::print("\n{}\n", findFailures(outcome).empty() ? "good" : "failed");
  fmt::print("largest energy {:.4g} J, off by {:.2e} of it, {:.2e} allowed\n", outcome.peak,
             outcome.unaccounted, outcome.allowed);
  if (!one.joints.empty()) fmt::print("joints open by {:.2e} m at most\n", outcome.pin_gap);
}

/// `tandem bench stress`: random cases, each with an energy account.
class StressCommand final : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.flag("--json", output_.json, "print stress.json to stdout");
    arguments.flag("--quick", quick_, "1000 cases, a coarser map");
    arguments.option("--cases", cases_, "so many cases, and a twentieth more with joints");
    arguments.option("--seed", seed_, "another seed, other cases");
    arguments.option("--case", one_, "this case alone, with its account");
    arguments.option("--out", output_.folder,
                     "folder for stress.json, stability.svg, stability.png");
  }

  ExitStatus run() override {
    const bool is_good = one_ ? runOne(*one_) : runAll();
    return is_good ? kDone : kCheckFailed;
  }

 private:
  bool runAll() {
    const StressOptions options = makeOptions();
    output_.open();
    const StressResult result = measure(options);
    output_.write("stress", makeStressJson(result).dump(2) + "\n", makeStressTable(result));
    return result.countFailed() == 0;
  }

  bool runOne(std::uint64_t index) const {
    const StressCase one = drawStressCase(seed_, index);
    std::vector<std::vector<AccountRow>> accounts;
    const StressOutcome outcome = runStressCase(one, &accounts);
    if (output_.json) {
      writeOutput(makeCaseJson(one, outcome).dump(2) + "\n");
    } else {
      printCase(one, outcome, accounts);
    }
    finishOutput();
    return findFailures(outcome).empty();
  }

  StressOptions makeOptions() const {
    StressOptions options;
    options.seed = seed_;
    options.quick = quick_;
    options.cases = cases_.value_or(quick_ ? kQuickCases : kCases);
    if (options.cases < 1 || options.cases > kMostCases)
      throw UsageError(fmt::format("--cases {}: must be 1 to {}", options.cases, kMostCases));
    options.joined_cases = (options.cases + kCasesPerJoined - 1) / kCasesPerJoined;
    return options;
  }

  static StressResult measure(const StressOptions& options) {
    ProgressLine line;
    return measureStress(options,
                         [&](std::string_view what, double share) { line.show(what, share); });
  }

  bool quick_ = false;
  std::uint64_t seed_ = 1;
  std::optional<std::uint64_t> cases_;  // empty: kCases or kQuickCases
  std::optional<std::uint64_t> one_;
  ResultOutput output_;
};

}  // namespace

CommandEntry stressCommand() {
  return {"stress",
          "energy account of thousands of scenes with absurd numbers; exit 3 if one fails", 3,
          makeCommand<StressCommand>};
}

}  // namespace tandem::demos
