#include <algorithm>
#include <cstdint>
#include <optional>
#include <thread>

#include <fmt/format.h>

#include "bench/guest/guest.h"
#include "bench/guest/guest_acts.h"
#include "bench/program/result_output.h"
#include "demos/program/command/command.h"
#include "demos/program/terminal/standard_output.h"
#include "demos/program/terminal/status_line.h"
#include "demos/program/terminal/usage_error.h"

namespace tandem::demos {
namespace {

using namespace bench;

constexpr std::uint64_t kQuickCases = 500, kMostCases = 10000000;

/// `tandem bench guest`: random worlds in which hosts do what hosts do.
class GuestCommand final : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.flag("--json", output_.json, "print guest.json to stdout");
    arguments.flag("--quick", quick_, "500 cases");
    arguments.flag("--acts", lists_, "list what the hosts do");
    arguments.flag("--reduce", reduces_, "with --case: as few acts as still fail");
    arguments.option("--cases", cases_, "so many cases");
    arguments.option("--seed", seed_, "another seed, other cases");
    arguments.option("--case", one_, "this case alone, with its acts");
    arguments.option("--jobs", jobs_, "so many processes at a time");
  }

  ExitStatus run() override {
    if (lists_) return listActs();
    return (one_ ? runOne(*one_) : runAll()) ? kDone : kCheckFailed;
  }

 private:
  ExitStatus listActs() const {
    for (const GuestAct& act : guestActs()) fmt::print("{}\n", act.name);
    finishOutput();
    return kDone;
  }

  bool runAll() {
    GuestOptions options;
    options.seed = seed_;
    options.cases = cases_.value_or(quick_ ? kQuickCases : options.cases);
    options.workers = static_cast<int>(std::clamp<std::uint64_t>(jobs_, 1, 256));
    if (options.cases < 1 || options.cases > kMostCases)
      throw UsageError(fmt::format("--cases {}: must be 1 to {}", options.cases, kMostCases));
    ProgressLine line;
    const GuestResult result =
        measureGuest(options, [&](double share) { line.show("cases", share); });
    output_.write("guest", makeGuestJson(result), makeGuestTable(result));
    return result.countFailed() == 0;
  }

  bool runOne(std::uint64_t index) const {
    GuestCase one = drawGuestCase(seed_, index);
    if (reduces_) one = reduceGuestCase(one);
    fmt::print("{}", describeCase(one));
    std::fflush(stdout);
    const GuestOutcome outcome = runGuestCase(one);
    fmt::print("{} at {:.4f} s: {}\n", nameOf(outcome.failure), outcome.time, outcome.text);
    finishOutput();
    return outcome.failure == GuestFailure::kNone;
  }

  bool quick_ = false, lists_ = false, reduces_ = false;
  std::uint64_t seed_ = 1, jobs_ = std::max(1U, std::thread::hardware_concurrency());
  std::optional<std::uint64_t> cases_, one_;
  ResultOutput output_;
};

}  // namespace

CommandEntry guestCommand() {
  return {"guest", "random worlds in which hosts do what hosts do; exit 3 if one breaks", 4,
          makeCommand<GuestCommand>};
}

}  // namespace tandem::demos
