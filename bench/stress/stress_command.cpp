#include "bench/stress/stress_command.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/stress/stress.h"
#include "bench/stress/stress_report.h"
#include "demos/program/plot/drawing.h"
#include "demos/program/run/run_output.h"
#include "demos/program/terminal/progress_line.h"
#include "demos/program/terminal/standard_output.h"
#include "demos/program/terminal/usage_error.h"

namespace tandem::demos::bench {
namespace {

constexpr std::uint64_t kCases = 20000, kQuickCases = 1000, kMostCases = 10000000;

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

bool runOne(const StressCommand& command, std::uint64_t index) {
  const StressCase one = drawStressCase(command.seed, index);
  std::vector<std::vector<AccountRow>> accounts;
  const StressOutcome outcome = runStressCase(one, &accounts);
  if (command.json) {
    writeOutput(makeCaseJson(one, outcome).dump(2) + "\n");
  } else {
    fmt::print("{}", describeCase(one));
    for (std::size_t s = 0; s < accounts.size(); ++s) {
      fmt::print("\nenergy at site {} [s, J]\n", s + 1);
      printAccount(accounts[s]);
    }
    fmt::print("\n{}\n", makeCaseJson(one, outcome)["failures"].empty() ? "good" : "failed");
    fmt::print("largest energy {:.4g} J, off by {:.2e} of it, {:.2e} allowed\n", outcome.peak,
               outcome.unaccounted, outcome.allowed);
  }
  finishOutput();
  return findFailures(outcome).empty();
}

}  // namespace

bool runStressCommand(const StressCommand& command) {
  if (command.one) return runOne(command, *command.one);
  StressOptions options;
  options.seed = command.seed;
  options.quick = command.quick;
  options.cases = command.cases.value_or(command.quick ? kQuickCases : kCases);
  if (options.cases < 1 || options.cases > kMostCases)
    throw UsageError(fmt::format("--cases {}: must be 1 to {}", options.cases, kMostCases));
  if (command.folder) {
    prepareFolder(*command.folder);
    requireDrawing();
  }
  StressResult result;
  {
    ProgressLine line;
    result = measureStress(options,
                           [&](std::string_view what, double share) { line.show(what, share); });
  }
  const std::string json = makeStressJson(result).dump(2) + "\n";
  if (command.folder) {
    const auto file = std::filesystem::path(*command.folder) / "stress.json";
    writeText(file, json);
    drawBench(file);
  }
  writeOutput(command.json ? json : makeStressTable(result));
  return result.countFailed() == 0;
}

}  // namespace tandem::demos::bench
