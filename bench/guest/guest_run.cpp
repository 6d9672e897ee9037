#include "bench/guest/guest_run.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <memory>

#include "tandem/coordination/simulated_link.h"

#include "bench/guest/guest_acts.h"
#include "bench/guest/guest_fresh.h"
#include "bench/guest/guest_site.h"
#include "bench/guest/guest_verdict.h"

namespace tandem::demos::bench {
namespace {

/// All sites of a case, and the links between them.
class GuestRun {
 public:
  explicit GuestRun(const GuestCase& one) : case_(one) {
    for (int i = 0; i < one.sites; ++i) sites_.push_back(std::make_unique<GuestSite>(one, i));
    Impairments network;
    network.delay = one.delay;
    network.loss = one.loss;
    network.seed = one.index;
    for (int i = 0; i < one.sites; ++i)
      for (int j = i + 1; j < one.sites; ++j) {
        auto [first, second] = makeSimulatedLinks(network, 256);
        sites_[static_cast<std::size_t>(i)]->connect(j, *first);
        sites_[static_cast<std::size_t>(j)]->connect(i, *second);
        links_.push_back(std::move(first));
        links_.push_back(std::move(second));
      }
  }
  ~GuestRun() {
    for (const auto& site : sites_) site->end();
  }

  std::optional<GuestFinding> run(GuestOutcome& outcome) {
    GuestVerdict verdict(case_, sites_);
    for (int step = 0; step * case_.frame < case_.duration; ++step) {
      outcome.time = step * case_.frame;
      verdict.beforeActs();
      doActs(outcome);
      verdict.afterActs();
      for (const auto& site : sites_) site->step(outcome.time);
      const auto found = verdict.look();
      outcome.energy = verdict.energyShare();
      if (found) return found;
    }
    end(outcome);
    if (auto found = verdict.lookAtEnd()) return found;
    for (const auto& site : sites_)
      if (std::string what = compareFreshWorlds(*site); !what.empty())
        return GuestFinding{GuestFailure::kGoesOn, what};
    return std::nullopt;
  }

 private:
  void doActs(GuestOutcome& outcome) {
    for (; next_ < case_.acts.size() && case_.acts[next_].time <= outcome.time; ++next_) {
      const GuestActPlan& plan = case_.acts[next_];
      for (int i = 0; i < case_.sites; ++i)
        if (plan.site < 0 || plan.site == i) sites_[static_cast<std::size_t>(i)]->doAct(plan);
      ++outcome.acts;
    }
  }

  /// Bodies that the hosts took out come back, at times without a step before the site ends.
  void end(GuestOutcome& outcome) {
    for (const auto& site : sites_) {
      site->world().putBack();
      site->twin().putBack();
      if (case_.index % 2 == 0) site->step(outcome.time += case_.frame);
      if (case_.world_ends_first) {
        site->world().endWorld();
        site->twin().endWorld();
      }
      site->end();
    }
  }

  const GuestCase& case_;
  std::vector<std::unique_ptr<SimulatedLink>> links_;
  std::vector<std::unique_ptr<GuestSite>> sites_;
  std::size_t next_ = 0;
};

}  // namespace

std::string_view nameOf(GuestFailure failure) {
  constexpr std::string_view kNames[] = {"good",   "crash", "throw",    "not_finite", "fell",
                                         "energy", "twin",  "restored", "goes_on"};
  return kNames[static_cast<int>(failure)];
}

GuestOutcome runGuestCase(const GuestCase& one) {
  GuestOutcome outcome;
  outcome.index = one.index;
  const auto start = std::chrono::steady_clock::now();
  std::optional<GuestFinding> found;
  try {
    GuestRun run(one);
    found = run.run(outcome);
  } catch (const std::exception& error) {
    found = GuestFinding{GuestFailure::kThrow, error.what()};
  }
  if (found) {
    outcome.failure = found->failure;
    std::snprintf(outcome.text, sizeof outcome.text, "%s", found->text.c_str());
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  outcome.seconds = wall.count();
  return outcome;
}

}  // namespace tandem::demos::bench
