#include "analyse/growth_warning.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "analyse/analysis.h"
#include "analyse/loop_of_scenario.h"
#include "analyse/safe_gains.h"
#include "terminal/usage_error.h"

namespace tandem::demos {

std::optional<LoopSettings> findLoop(const Scenario& scenario) {
  try {
    const LoopSettings loop = makeLoop(scenario);
    (void)findAnalysedPacketRate(loop);  // refuses numbers that no loop may have
    return loop;
  } catch (const UsageError&) {
    return std::nullopt;
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

std::string describeGrowth(const ModeGrowth& worst) {
  return fmt::format(
      "with lasting contact and empty hands, motion {} doubles in {:.2g} s, at {:.1f} Hz",
      explain(worst.mode), std::log(2.0) / worst.growth.rate, worst.growth.frequency);
}

std::vector<std::string> warnBeforeTouch(const Scenario& scenario) {
  std::vector<std::string> lines;
  if (const auto chosen = tellChosenGains(scenario)) lines.push_back(*chosen);
  const auto loop = findLoop(scenario);
  if (!loop) return lines;
  const ModeGrowth worst = computeWorstGrowth(*loop);
  if (!(worst.growth.rate < 0.0))
    lines.push_back(describeGrowth(worst) + "; tandem analyse tells which gain to turn");
  return lines;
}

}  // namespace tandem::demos
