#include "bench/stress/stress_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "bench/stress/paper_check.h"
#include "bench/stress/stress_site.h"
#include "bench/stress/stress_stability.h"

namespace tandem::demos::bench {
namespace {

/// Number of looks and integrator steps after which a case ends early.
constexpr std::uint64_t kMostWork = 10000000;

/// Part of the work of shifts by which the account may be off. It cannot tell when in a step a
/// velocity changed, and what of a way is no motion.
constexpr double kShiftPart = 0.5;

/// A case being run.
class StressRun {
 public:
  explicit StressRun(const StressCase& one) : case_(one) {
    if (isScripted()) {
      sites_.push_back(std::make_unique<StressSite>(one, 0, std::vector<Link*>{}));
      return;
    }
    std::tie(ends_[0], ends_[1]) = makeSimulatedLinks(one.network, 8192);
    for (std::size_t s = 0; s < 2; ++s)
      sites_.push_back(std::make_unique<StressSite>(one, s, std::vector<Link*>{ends_[s].get()}));
    for (const auto& site : sites_) start_energy_ += site->account().stock().sum();
  }

  void setTraces(std::vector<std::vector<AccountRow>>& traces) {
    traces.resize(sites_.size());
    for (std::size_t s = 0; s < sites_.size(); ++s) sites_[s]->account().setTrace(&traces[s]);
  }

  void run(StressOutcome& outcome) {
    std::optional<PaperCheck> paper;
    if (case_.kind == StressKind::kPaper) paper.emplace(case_);
    const auto ticks = static_cast<std::uint64_t>(std::ceil(case_.duration * case_.haptic_rate));
    for (std::uint64_t tick = 0; tick < ticks; ++tick) {
      double total = 0.0, brought = start_energy_;
      for (const auto& site : sites_) {
        site->tick(tick);
        outcome.finite = outcome.finite && site->isFinite();
        total += site->account().stock().sum() + site->deviceEnergy();
        brought += site->handWork();
      }
      if (!isScripted() && brought > 0.0)
        outcome.growth = std::max(outcome.growth, total / (brought * (1.0 + heaviestStandIn())));
      // A loop that has exploded turns rounding into any way.
      if (paper && outcome.growth <= kMostGrowth)
        paper->compare(tick, displacementOf(0, sites_[0]->tickHandle()),
                       displacementOf(1, sites_[1]->tickHandle()));
      outcome.simulated = static_cast<double>(tick + 1) / case_.haptic_rate;
      if (!outcome.finite) break;
      if ((outcome.was_cut = countWork() > kMostWork)) break;
    }
    for (const auto& site : sites_) include(outcome, *site);
    outcome.steps = countWork();
    if (paper) outcome.deviation = paper->worst();
  }

 private:
  [[nodiscard]] bool isScripted() const { return case_.users[1].is_scripted; }

  /// Displacement along the axis of a case of the paper.
  [[nodiscard]] double displacementOf(std::size_t user, const Vec3& handle_W) const {
    return (handle_W - case_.users[user].path.start_W).x();
  }

  /// A stand-in for a user moves as fast as the user's device, and may be heavier than it.
  [[nodiscard]] double heaviestStandIn() const {
    double most = 0.0;
    for (const StressUser& user : case_.users)
      most = std::max(most, case_.proxy_mass / user.device_mass);
    return most;
  }

  [[nodiscard]] std::uint64_t countWork() const {
    std::uint64_t work = 0;
    for (const auto& site : sites_) {
      const IslandCounters& counters = site->island().counters();
      work += site->account().looks() + counters.integrated_steps + 8 * counters.rigid_steps;
    }
    return work;
  }

  void include(StressOutcome& outcome, const StressSite& site) const {
    const EnergyAccount& account = site.account();
    outcome.finite = outcome.finite && account.isFinite();
    outcome.work_in += account.flows().sum();
    outcome.start_energy += account.startStock().sum();
    outcome.end_energy += account.stock().sum();
    outcome.peak = std::max(outcome.peak, account.peak());
    outcome.pin_gap = std::max(outcome.pin_gap, site.pinGap());
    if (account.worstJump() > outcome.jump) {
      outcome.jump = account.worstJump();
      outcome.jump_time = account.worstJumpTime();
    }
    if (!(account.peak() > 0.0)) return;
    const double part = account.unaccounted() / account.peak();
    outcome.allowed = std::max(outcome.allowed, computeAllowed(site));
    outcome.host_contact =
        std::max(outcome.host_contact, account.hostContactEnergy() / account.peak());
    if (!(part > outcome.unaccounted)) return;
    outcome.unaccounted = part;
    outcome.unaccounted_time = account.unaccountedTime();
  }

  /// Part of the largest energy by which the account may be off: rounding, the doubt in the hand's
  /// work, and the known error of rigid contact.
  [[nodiscard]] double computeAllowed(const StressSite& site) const {
    const EnergyAccount& account = site.account();
    double allowed = std::max(kEnergyTolerance, 100.0 * account.rounding() / account.peak());
    allowed += account.doubt() / account.peak();
    if (case_.kind == StressKind::kJoined) return std::max(allowed, kJoinedTolerance);
    if (case_.kind != StressKind::kRigid && case_.kind != StressKind::kNeighbours) return allowed;
    if (site.island().counters().rigid_points == 0) return allowed;
    allowed = std::max(allowed, kRigidTolerance) + kShiftPart * account.shifted() / account.peak();
    // Work in a tick is bounded: then steps are taken as they are.
    if (site.island().counters().rigid_bounded > 0) allowed = std::max(allowed, kBoundedTolerance);
    return allowed;
  }

  const StressCase& case_;
  std::unique_ptr<SimulatedLink> ends_[2];
  std::vector<std::unique_ptr<StressSite>> sites_;
  double start_energy_ = 0.0;
};

}  // namespace

StressOutcome runStressCase(const StressCase& one, std::vector<std::vector<AccountRow>>* traces) {
  StressOutcome outcome;
  outcome.index = one.index;
  outcome.kind = static_cast<std::int32_t>(one.kind);
  outcome.is_stable = isAnalysedStable(one);
  const auto start = std::chrono::steady_clock::now();
  try {
    StressRun run(one);
    if (traces) run.setTraces(*traces);
    run.run(outcome);
  } catch (const std::invalid_argument&) {
    outcome.refused = true;
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  outcome.seconds = wall.count();
  return outcome;
}

}  // namespace tandem::demos::bench
