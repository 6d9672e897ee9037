#include "bench/guest/guest.h"

#include <algorithm>
#include <chrono>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/guest/guest_acts.h"
#include "bench/program/case_workers.h"

namespace tandem::demos::bench {
namespace {

constexpr unsigned kMostSeconds = 60;  // a case that takes longer hangs
constexpr int kListed = 20;

/// Runs a case in a process of its own.
GuestFailure runAlone(const GuestCase& one) {
  const pid_t process = fork();
  if (process < 0) throw Error("cannot start a process; close other programs");
  if (process == 0) {
    alarm(kMostSeconds);
    _exit(static_cast<int>(runGuestCase(one).failure));
  }
  int status = 0;
  waitpid(process, &status, 0);
  return WIFEXITED(status) ? static_cast<GuestFailure>(WEXITSTATUS(status)) : GuestFailure::kCrash;
}

}  // namespace

std::size_t GuestResult::countFailed() const {
  return static_cast<std::size_t>(std::count_if(
      outcomes.begin(), outcomes.end(),
      [](const GuestOutcome& outcome) { return outcome.failure != GuestFailure::kNone; }));
}

GuestResult measureGuest(const GuestOptions& options, const std::function<void(double)>& progress) {
  GuestResult result;
  result.options = options;
  const auto start = std::chrono::steady_clock::now();
  result.outcomes = runInWorkers<GuestOutcome>(
      options.cases, options.workers,
      [&](std::uint64_t index) {
        alarm(kMostSeconds);
        return runGuestCase(drawGuestCase(options.seed, index));
      },
      [](std::uint64_t) {
        GuestOutcome outcome;
        outcome.failure = GuestFailure::kCrash;
        return outcome;
      },
      progress);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  result.seconds = wall.count();
  return result;
}

GuestCase reduceGuestCase(GuestCase one) {
  const GuestFailure failure = runAlone(one);
  if (failure == GuestFailure::kNone) return one;
  for (std::size_t a = one.acts.size(); a-- > 0;) {
    GuestCase fewer = one;
    fewer.acts.erase(fewer.acts.begin() + static_cast<std::ptrdiff_t>(a));
    if (runAlone(fewer) == failure) one = fewer;
  }
  return one;
}

std::string makeGuestTable(const GuestResult& result) {
  std::map<GuestFailure, std::size_t> counts;
  double energy = 0.0, work = 0.0;
  std::size_t acts = 0;
  for (const GuestOutcome& outcome : result.outcomes) {
    ++counts[outcome.failure];
    energy = std::max(energy, outcome.energy);
    work += outcome.seconds;
    acts += static_cast<std::size_t>(outcome.acts);
  }
  std::string text = fmt::format("{:<12}{:>9}\n", "outcome", "cases");
  for (const auto& [failure, count] : counts)
    text += fmt::format("{:<12}{:>9}\n", nameOf(failure), count);
  text += fmt::format(
      "{} cases of seed {} with {} acts of {} kinds in {:.0f} s, {:.1f} ms a case; energy at most "
      "{:.2f} of the allowed\n",
      result.outcomes.size(), result.options.seed, acts, guestActs().size(), result.seconds,
      1e3 * work / static_cast<double>(result.outcomes.size()), energy);
  int listed = 0;
  for (const GuestOutcome& outcome : result.outcomes) {
    if (outcome.failure == GuestFailure::kNone || ++listed > kListed) continue;
    text += fmt::format("{} at {:.4f} s: {}\n  tandem bench guest --seed {} --case {} --reduce\n",
                        nameOf(outcome.failure), outcome.time, outcome.text, result.options.seed,
                        outcome.index);
  }
  return text;
}

std::string makeGuestJson(const GuestResult& result) {
  nlohmann::json json = {{"format", "tandem-bench-guest"}, {"version", 1},
                         {"seed", result.options.seed},    {"cases", result.outcomes.size()},
                         {"seconds", result.seconds},      {"failed", nlohmann::json::array()}};
  for (const GuestAct& act : guestActs()) json["acts"].push_back(act.name);
  for (const GuestOutcome& outcome : result.outcomes)
    if (outcome.failure != GuestFailure::kNone)
      json["failed"].push_back({{"case", outcome.index},
                                {"failure", nameOf(outcome.failure)},
                                {"time", outcome.time},
                                {"text", outcome.text}});
  return json.dump(2) + "\n";
}

}  // namespace tandem::demos::bench
