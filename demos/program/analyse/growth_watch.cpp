#include "analyse/growth_watch.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "analyse/growth_warning.h"
#include "analyse/loop_of_scenario.h"

namespace tandem::demos {
namespace {

/// A change of delay is news from here on: the larger of both [s], and as a part of the delay.
constexpr double kLeastChange = 2e-3, kLeastPart = 0.1;

}  // namespace

GrowthWatch::GrowthWatch(const Scenario& scenario) : loop_(findLoop(scenario)) {}

std::optional<std::string> GrowthWatch::look(double delay) {
  if (!loop_ || !(delay >= 0.0)) return std::nullopt;
  std::optional<std::string> line;
  if (running_.valid()) {
    if (running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return line;
    const Verdict verdict = running_.get();
    const bool fits = verdict.worst.growth.rate < 0.0;
    if (fits != fits_) line = tell(verdict);
    fits_ = fits;
  }
  if (isNews(delay)) {
    judged_ = delay;
    running_ = std::async(std::launch::async, &GrowthWatch::judge, *loop_, delay);
  }
  return line;
}

bool GrowthWatch::isNews(double delay) const noexcept {
  return !judged_ || std::abs(delay - *judged_) > std::max(kLeastChange, kLeastPart * *judged_);
}

GrowthWatch::Verdict GrowthWatch::judge(LoopSettings loop, double delay) {
  loop.delay = std::min(delay, kLongestDelay);
  Verdict verdict{delay, computeWorstGrowth(loop), std::nullopt};
  if (verdict.worst.growth.rate < 0.0) return verdict;
  const SafeCoordination better = chooseCoordination(loop);
  if (better.rate < 0.0) verdict.better = better;
  return verdict;
}

std::string GrowthWatch::tell(const Verdict& verdict) {
  const double delay_ms = 1e3 * verdict.delay;
  if (verdict.worst.growth.rate < 0.0)
    return fmt::format("at the measured delay of {:.0f} ms the gains fit again", delay_ms);
  std::string line = fmt::format("at the measured delay of {:.0f} ms the gains do not fit: {}",
                                 delay_ms, describeGrowth(verdict.worst));
  if (verdict.better)
    line += fmt::format("; coordination.stiffness = {:.3g}, coordination.damping = {:.3g} fit",
                        verdict.better->gains.stiffness, verdict.better->gains.damping);
  return line;
}

}  // namespace tandem::demos
